/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares two folders: each frame with its accepted pictures, then what that means for the whole. */
#include "regression/regression.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"
#include "regression/regression_internal.h"
#include "regression/naming.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool judge_pixels(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                         Image *const images[SIDES], Error *error) {
    Image *expected = images[EXPECTED], *actual = images[ACTUAL];
    uint8_t *masked;
    if (!regression_ignore(regression, frame, expected, actual, &masked, error)) return false;
    regression_compare(regression, frame, expected, actual, masked);
    bool hidden = frame->difference.counted == 0 && regression_accepts_size(regression, frame);
    bool ok = hidden
                  ? error_input(error, frame->at[EXPECTED]->path, "the masks hide all its pixels: nothing is compared")
                  : regression_decide(regression, frame, expected, actual, masked, error);
    if (ok && frame->difference.pixels > 0)
        ok = regression_find_changes(regression, frame, data, (const Image *const[SIDES]){expected, actual}, masked,
                                     error);
    free(masked);
    return ok;
}

/* Row by row, in little memory, where that is enough: nothing is ignored, FLIP is not measured, and no file says what
   the pictures show. */
typedef struct RowJudge {
    int width, height, tolerance;
    ImageDifference difference;
    ImageRegions regions;
    RegionScan *scan;     /* from the first row that differs */
    ContentTraits traits; /* of some rows */
    ContentBand band;     /* the rows that differ, if they are few */
    Anchors shift[SIDES]; /* rows that differ */
    uint8_t *rows[SIDES]; /* [4 * width]; behind them: */
    uint8_t *levels;      /* [width] */
    Error error;
} RowJudge;

static bool begin_rows(void *context, int width, int height) {
    RowJudge *judge = context;
    const size_t count = (size_t)width;
    judge->width = width, judge->height = height;
    judge->difference =
        (ImageDifference){.same_size = true, .counted = (int64_t)width * height, .first_x = -1, .first_y = -1};
    if ((judge->rows[EXPECTED] = malloc(9 * count)) == NULL) return error_memory(&judge->error, "image");
    judge->rows[ACTUAL] = judge->rows[EXPECTED] + 4 * count;
    judge->levels = judge->rows[ACTUAL] + 4 * count;
    content_band_begin(&judge->band, width, height);
    return true;
}

static uint8_t *place_row(void *context, int side, int y) {
    RowJudge *judge = context;
    (void)y;
    return judge->rows[side];
}

static void judge_difference(RowJudge *judge, int y, const uint8_t *a, const uint8_t *b) {
    image_levels(a, b, (size_t)judge->width, judge->levels);
    image_count_levels(&judge->difference, y, judge->levels, judge->width, judge->tolerance);
    if (judge->scan == NULL)
        judge->scan = region_scan_create(judge->width, judge->height, &judge->regions, &judge->error);
    if (judge->scan != NULL) region_scan_row(judge->scan, y, judge->levels);
    (void)shift_rows_add(judge->shift, y, a, b, judge->width, &judge->error);
    if (y % CONTENT_ROWS == 0) traits_add_row(&judge->traits, a, b, judge->levels, 0, judge->width);
}

static void judge_row(void *context, int y, const uint8_t *a, const uint8_t *b) {
    RowJudge *judge = context;
    if (judge->error.kind != ERROR_NONE) return;
    if (a != b) judge_difference(judge, y, a, b);
    if (!content_band_add(&judge->band, y, a, b, judge->difference.pixels)) error_memory(&judge->error, "regions");
}

/* The regions of a frame and their names. *named: false where only whole pictures can tell, and are small enough. */
static bool name_rows(RowJudge *judge, RegressionFrame *frame, bool *named, Error *error) {
    const Image rows[2] = {content_band_rows(&judge->band, EXPECTED), content_band_rows(&judge->band, ACTUAL)};
    const bool ground = content_has_ground(&judge->traits, &judge->difference, judge->width, judge->height);
    const bool lost = ground && judge->band.lost;
    bool shifted = false;
    if (!ground && frame_failed(frame) &&
        !content_may_be_shifted(rows, judge->shift, &judge->traits, judge->width, judge->height, &shifted, error))
        return false;
    *named = !frame_failed(frame) || !(shifted || (lost && (int64_t)judge->width * judge->height <= CONTENT_WHOLE_MAX));
    if (judge->difference.equal || !*named) return true;
    if (!regression_keep_regions(frame, &judge->regions, error)) return false;
    if (!frame_failed(frame) || lost) return true;
    if (ground)
        return content_name_by_ground(&rows[0], &rows[1], judge->band.first, NULL, traits_floor(&judge->traits),
                                      &judge->difference, frame->changes, error);
    content_name_most(&judge->traits, frame->changes);
    return true;
}

/* *done: the files are read in pieces, have one size, and are sound, and that is enough to name what changed. */
static bool judge_rows(const Regression *regression, RegressionFrame *frame, PngFile files[SIDES], bool *done,
                       Error *error) {
    RowJudge judge = {.tolerance = regression_level(regression, frame)};
    const RowSink sink = {begin_rows, place_row, judge_row, &judge, CONTENT_MARGIN};
    *done = png_files_scan(files, regression->count == 1, &sink);
    bool ok = judge.error.kind == ERROR_NONE;
    if (ok && *done) {
        if (judge.scan != NULL) region_scan_end(judge.scan, judge.height);
        judge.difference.equal = judge.difference.pixels == 0;
        frame->difference = judge.difference;
        ok = regression_decide(regression, frame, NULL, NULL, NULL, error) && name_rows(&judge, frame, done, error);
    }
    region_scan_destroy(judge.scan);
    content_band_end(&judge.band);
    free(judge.shift[EXPECTED].list), free(judge.shift[ACTUAL].list);
    free(judge.rows[EXPECTED]);
    if (judge.error.kind != ERROR_NONE) *error = judge.error;
    return ok;
}

/* Sets the sizes in pixels. What is read in pieces has been checked. */
static bool check_chunks(RegressionFrame *frame, const PngFile files[SIDES], Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const PngFile *from = &files[side];
        RegressionFile *file = &frame->files[side];
        if (from->rows != NULL)
            (void)png_size(from->data, from->size, &file->width, &file->height);
        else if (!png_check(from->data, from->size, from->path, &file->width, &file->height, error))
            return false;
    }
    return true;
}

/* Damage is found without memory for the pixels: where a common file has it, and where the pixels are many. */
static bool check_damage(RegressionFrame *frame, PngFile files[SIDES], Error *error) {
    enum { MANY = 1 << 24 };
    const bool found = files[EXPECTED].damaged || files[ACTUAL].damaged;
    bool ok = check_chunks(frame, files, error);
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++) {
        const RegressionFile *file = &frame->files[side];
        if (found ? files[side].damaged : (int64_t)file->width * file->height >= MANY)
            ok = png_file_check(&files[side], error);
    }
    return ok;
}

static bool decode_and_judge(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], Error *error) {
    Image *images[SIDES];
    bool rows, done = false;
    if (!regression_needs_rows_alone(regression, frame, &rows, error)) return false;
    if (rows && !judge_rows(regression, frame, files, &done, error)) return false;
    if (done) return true;
    if (rows && !check_damage(frame, files, error)) return false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (!png_file_load(&files[side], error)) return false;
        frame->files[side].size = files[side].size;
    }
    uint8_t *const data[SIDES] = {files[EXPECTED].data, files[ACTUAL].data};
    bool ok = image_decode_png_pair((const uint8_t *const[]){data[EXPECTED], data[ACTUAL]},
                                    (const size_t[]){files[EXPECTED].size, files[ACTUAL].size},
                                    (const char *const[]){files[EXPECTED].path, files[ACTUAL].path},
                                    regression->options.max_pixels, images, error);
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++)
        frame->files[side].width = images[side]->width, frame->files[side].height = images[side]->height;
    ok = ok && judge_pixels(regression, frame, data, images, error);
    image_destroy_pair(images);
    return ok;
}

/* A missing or extra frame is decoded too, to detect damaged files. */
static bool judge_alone(RegressionFrame *frame, RegressionSide side, PngFile *from, Error *error) {
    assert(frame->at[side] != NULL);
    RegressionFile *file = &frame->files[side];
    if (!png_file_check(from, error)) return false;
    (void)png_size(from->data, from->size, &file->width, &file->height);
    frame->pixels = side == EXPECTED ? PIXELS_MISSING : PIXELS_EXTRA;
    return true;
}

/* Decoded only to find out whether the masks hide everything: that must not stay unknown until something changes. */
static bool judge_same_bytes(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], Error *error) {
    const RegressionFile *file = &frame->files[EXPECTED];
    if (!check_chunks(frame, files, error)) return false;
    if (regression_may_hide_all(regression, frame, file->width, file->height))
        return decode_and_judge(regression, frame, files, error);
    frame->pixels = PIXELS_EQUAL;
    frame->difference = (ImageDifference){.equal = true, .same_size = true, .first_x = -1, .first_y = -1};
    return true;
}

/* Whether the overlap is so small a part of the larger picture that it says nothing; and decoding both would let a
   small file cost what the largest picture costs. */
static bool is_far(const RegressionFile *a, const RegressionFile *b) {
    const int64_t LEAST_PART = 16;
    const int64_t width = a->width < b->width ? a->width : b->width,
                  height = a->height < b->height ? a->height : b->height;
    const int64_t of_a = (int64_t)a->width * a->height, of_b = (int64_t)b->width * b->height;
    return width * height < (of_a > of_b ? of_a : of_b) / LEAST_PART;
}

/* By the headers alone. False: the pictures have to be decoded, or cannot. */
static bool have_far_sizes(RegressionFrame *frame, const PngFile files[SIDES]) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        RegressionFile *file = &frame->files[side];
        if (!png_size(files[side].data, files[side].size, &file->width, &file->height)) return false;
    }
    return is_far(&frame->files[EXPECTED], &frame->files[ACTUAL]);
}

static bool judge_sizes(const Regression *regression, RegressionFrame *frame, const PngFile files[SIDES],
                        Error *error) {
    if (!check_chunks(frame, files, error)) return false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const RegressionFile *file = &frame->files[side];
        if (!png_check_pixels(file->width, file->height, regression->options.max_pixels, files[side].path, error))
            return false;
    }
    frame->pixels = PIXELS_RESIZED;
    frame->sizes_alone = true;
    frame->difference = (ImageDifference){.first_x = -1, .first_y = -1};
    return true;
}

static bool regression_judge(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], Error *error) {
    const PngFile *a = &files[EXPECTED], *b = &files[ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (frame->at[1 - side] == NULL) return judge_alone(frame, side, &files[side], error);
    if (!regression_judge_states(regression, frame, (uint8_t *const[]){a->data, b->data}, error)) return false;
    if (png_files_are_same(files)) return judge_same_bytes(regression, frame, files, error);
    if (!png_display_compare(a->data, a->size, b->data, b->size, &frame->metadata, error)) return false;
    frame->metadata_failed = regression->options.strict_metadata && frame->metadata.text[0] != '\0';
    return have_far_sizes(frame, files) ? judge_sizes(regression, frame, files, error)
                                        : decode_and_judge(regression, frame, files, error);
}

static bool compare_files(Regression *regression, RegressionFrame *frame, Error *error) {
    PngFile files[SIDES] = {{0}};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++) {
        if (frame->at[side] == NULL) continue;
        ok = png_file_open(&files[side], frame->at[side]->path, regression->options.max_pixels, error);
        frame->files[side] = (RegressionFile){.hash = files[side].hash, .size = files[side].size};
    }
    ok = ok && regression_judge(regression, frame, files, error);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        frame->files[side].size = files[side].bytes; /* up to here, of what is in memory */
        png_file_close(&files[side]);
    }
    return ok;
}

static bool check_file(const char *path, Error *error) {
    size_t size;
    int width, height;
    uint8_t *data = image_load_png(path, &size, error);
    bool ok = data != NULL && png_check(data, size, path, &width, &height, error);
    free(data);
    return ok;
}

static bool is_closer(const RegressionFrame *a, const RegressionFrame *b) {
    const ImageDifference *x = &a->difference, *y = &b->difference;
    if (frame_failed(a) != frame_failed(b)) return frame_failed(b);
    if (x->same_size != y->same_size) return x->same_size;
    return x->pixels != y->pixels ? x->pixels < y->pixels : x->largest < y->largest;
}

/* Sets what the frame's files alone tell: pixels, states, metadata, changes. Where several pictures are accepted, the
   first that passes counts, or else the closest. Thread-safe. ERROR_INPUT if a file cannot be read. */
static bool compare_accepted(Regression *regression, RegressionFrame *frame, Error *error) {
    const RegressionFrame fresh = *frame;
    if (!compare_files(regression, frame, error)) return false;
    for (const SequenceFrame *other = frame->base->next; other != NULL; other = other->next) {
        if (!frame_failed(frame)) { /* it is not needed, but damage is told */
            if (!check_file(other->path, error)) return false;
            continue;
        }
        RegressionFrame attempt = fresh;
        attempt.at[EXPECTED] = other;
        bool ok = compare_files(regression, &attempt, error), closer = ok && is_closer(&attempt, frame);
        free(closer ? frame->changes : attempt.changes);
        if (closer) *frame = attempt;
        if (!ok) return false;
    }
    return true;
}

/* If a frame cannot be read, the others are still compared. */
static bool compare_frame(void *context, int i, Error *error) {
    Regression *regression = context;
    RegressionFrame *frame = &regression->frames[i];
    RegressionFrame unread = *frame;
    const double begun = clock_seconds();
    Error read_error = {0};
    bool ok = compare_accepted(regression, frame, &read_error);
    frame->seconds = clock_seconds() - begun;
    if (!ok && read_error.kind == ERROR_INPUT && (unread.read_error = strdup(read_error.message)) != NULL) {
        unread.pixels = PIXELS_UNREAD;
        unread.seconds = frame->seconds;
        free(frame->changes);
        *frame = unread;
        return true;
    }
    if (!ok) *error = read_error;
    return ok;
}

bool regression_was_read(const Regression *regression, Error *error) {
    int first = -1, count = 0;
    for (int i = regression->count - 1; i >= 0; i--)
        if (regression->frames[i].read_error != NULL) first = i, count++;
    if (first < 0) return true;
    error->kind = ERROR_INPUT;
    snprintf(error->message, sizeof error->message, "%s", regression->frames[first].read_error);
    if (count > 1) error_add(error, "\n(further frames that cannot be compared: %d)", count - 1);
    return false;
}

bool frame_failed(const RegressionFrame *frame) {
    return frame->pixels >= PIXELS_DIFFER || frame->states == STATES_DIFFER || frame->metadata_failed;
}

double frame_severity(const RegressionFrame *frame) {
    return frame->pixels >= PIXELS_RESIZED ? INFINITY : (double)frame->difference.pixels;
}

static int by_severity(const void *a, const void *b) {
    const RegressionFrame *x = *(const RegressionFrame *const *)a, *y = *(const RegressionFrame *const *)b;
    const double first = frame_severity(x), second = frame_severity(y);
    return first != second ? (first < second) - (first > second) : (x > y) - (x < y);
}

const RegressionFrame **regression_failures(const Regression *regression, Error *error) {
    const RegressionFrame **failures = malloc(((size_t)regression->failed + 1) * sizeof *failures);
    if (failures == NULL) return error_memory(error, "frames"), NULL;
    int count = 0;
    for (int i = 0; i < regression->count; i++)
        if (frame_failed(&regression->frames[i])) failures[count++] = &regression->frames[i];
    qsort(failures, (size_t)count, sizeof *failures, by_severity);
    return failures;
}

static void count_frame(Regression *regression, int i) {
    const RegressionFrame *frame = &regression->frames[i];
    bool pictures = frame->pixels == PIXELS_DIFFER || frame->pixels == PIXELS_RESIZED;
    regression->by_verdict[frame->pixels]++;
    regression->failed += frame_failed(frame);
    regression->physics += frame->states == STATES_DIFFER;
    bool view = pictures && frame->other_view && frame->states != STATES_DIFFER;
    regression->view += view;
    regression->elsewhere += pictures && !view && frame->states == STATES_DIFFER_ELSEWHERE;
    const bool renderer = pictures && !view && frame->states == STATES_EQUAL;
    if (renderer && !frame->alone && regression->first_renderer < 0) regression->first_renderer = i;
    regression->renderer += renderer;
    regression->unknown += pictures && !view && frame->states == STATES_UNKNOWN;
    if (frame->metadata.text[0] != '\0' && regression->metadata++ == 0) regression->first_metadata = i;
    regression->metadata_failed += frame->metadata_failed && !pictures && frame->states != STATES_DIFFER;
    regression->other_accepted += !frame_failed(frame) && frame->at[EXPECTED] != frame->base;
}

/* Sets STATES_DIFFER_ELSEWHERE (see StateVerdict) in the frames of one sequence. */
static void judge_sequence(RegressionFrame *const *frames, int count) {
    bool physics = false, same_framing = false;
    for (int i = 0; i < count; i++) {
        physics = physics || frames[i]->run_differs || frames[i]->states == STATES_DIFFER;
        bool same = frames[i]->at[EXPECTED] == frames[i]->base && frames[i]->pixels == PIXELS_EQUAL;
        same_framing = same_framing || (same && frames[i]->states == STATES_EQUAL);
    }
    for (int i = 0; physics && !same_framing && i < count; i++)
        if (frames[i]->states == STATES_EQUAL) frames[i]->states = STATES_DIFFER_ELSEWHERE;
}

/* Ignores missing and extra frames; their names may have another stem. */
static bool judge_sequences(Regression *regression, Error *error) {
    RegressionFrame **paired = malloc(((size_t)regression->count + 1) * sizeof *paired);
    if (paired == NULL) return error_memory(error, "frames");
    int count = 0;
    for (int i = 0; i < regression->count; i++)
        if (regression->frames[i].pixels < PIXELS_MISSING) paired[count++] = &regression->frames[i];
    for (int first = 0, end = 0; first < count; first = end) {
        while (end < count && sequence_compare_stems(paired[first]->base, paired[end]->base) == 0) end++;
        judge_sequence(paired + first, end - first);
    }
    free(paired);
    return true;
}

static void count(Regression *regression) {
    regression->first_renderer = regression->first_run = regression->first_metadata = -1;
    for (int i = 0; i < regression->count; i++) count_frame(regression, i);
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *runs = regression->runs;
        regression->run_within += runs[i].within;
        if (!run_failed(&runs[i])) continue;
        regression->run_failed++;
        for (RegressionSide side = EXPECTED; side < SIDES; side++) regression->runs_alone[side] += runs[i].alone[side];
        if (runs[i].alone[EXPECTED] || runs[i].alone[ACTUAL]) continue;
        int first = regression->first_run;
        if (first < 0 || (unsigned)runs[i].difference.frame < (unsigned)runs[first].difference.frame)
            regression->first_run = i;
    }
}

static bool share_stem(const RegressionFrame *a, const RegressionFrame *b) {
    return a->base->number >= 0 && b->base->number >= 0 && sequence_compare_stems(a->base, b->base) == 0;
}

static void find_films(Regression *regression) {
    RegressionFrame *frames = regression->frames;
    for (int i = 0; i < regression->count; i++) {
        frames[i].alone = !(i > 0 && share_stem(&frames[i - 1], &frames[i])) &&
                          !(i + 1 < regression->count && share_stem(&frames[i], &frames[i + 1]));
        regression->film = regression->film || !frames[i].alone;
    }
}

static bool pair_frames(Regression *regression, Error *error) {
    SequencePair *pairs =
        image_sequence_pair(regression->sequences[EXPECTED], regression->sequences[ACTUAL], &regression->count, error);
    if (pairs == NULL) return false;
    regression->frames = calloc((size_t)regression->count + 1, sizeof *regression->frames);
    for (int i = 0; regression->frames != NULL && i < regression->count; i++)
        regression->frames[i] = (RegressionFrame){.base = pairs[i].a != NULL ? pairs[i].a : pairs[i].b,
                                                  .at = {pairs[i].a, pairs[i].b},
                                                  .flip = NAN,
                                                  .flip_p99 = NAN};
    free(pairs);
    if (regression->frames == NULL) return error_memory(error, "frames");
    find_films(regression);
    return true;
}

static bool is_any(const char *name) { return (void)name, true; }

static bool is_empty(const char *folder) {
    FolderList files;
    Error ignored = {0};
    if (!folder_list(&files, folder, is_any, true, &ignored)) return false;
    const bool empty = files.count == 0;
    folder_list_free(&files);
    return empty;
}

/* A folder without pictures is an error, not a difference, unless neither has any and trajectories are compared. */
static bool refuse_empty(const Regression *regression, Error *error) {
    bool runs_alone = regression->count == 0 && regression->run_count > 0;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        if (sequence->count > 0 || runs_alone) continue;
        const char *pictures = side == EXPECTED ? "expected" : "actual";
        if (is_empty(sequence->folder))
            return error_input(error, sequence->folder, "the folder of the %s pictures is empty", pictures);
        return error_input(error, sequence->folder,
                           "the folder of the %s pictures has no PNG files (such as frame_000000.png)%s", pictures,
                           sequence->skipped > 0 ? ", only its subfolders do" : "");
    }
    return true;
}

/* Through a link or another spelling of the path, that is a mistake; the same path twice is meant. */
static bool refuse_same(const Regression *regression, const char *expected, const char *actual, Error *error) {
    const ImageSequence *a = regression->sequences[EXPECTED], *b = regression->sequences[ACTUAL];
    if (a->device != b->device || a->inode != b->inode || strcmp(expected, actual) == 0) return true;
    return error_input(
        error, actual,
        "is the same %s as %s: nothing would be compared; to compare it with itself, write one path twice",
        a->single ? "file" : "folder", expected);
}

bool regression_run(Regression *regression, const char *expected, const char *actual, const RegressionOptions *options,
                    const Progress *progress, Error *error) {
    *regression = (Regression){.options = *options};
    PoseTolerance *poses = &regression->options.poses;
    const double begun = clock_seconds();
    const ParallelWork work = {compare_frame, regression};
    bool ok = (regression->sequences[EXPECTED] = image_sequence_open(expected, !options->flat, error)) != NULL &&
              (regression->sequences[ACTUAL] = image_sequence_open(actual, !options->flat, error)) != NULL &&
              refuse_same(regression, expected, actual, error) && pair_frames(regression, error);
    poses->given = poses->given && (regression->count == 0 || (options->tolerance.given & LIMIT_TOLERANCE) == 0);
    ok = ok && regression_find_runs(regression, error) && refuse_empty(regression, error) &&
         regression_read_rules(regression, error) && parallel_for(&work, regression->count, actual, progress, error) &&
         judge_sequences(regression, error);
    if (ok) count(regression);
    ok = ok && regression_find_causes(regression, error);
    regression->seconds = clock_seconds() - begun;
    if (!ok) regression_free(regression);
    return ok;
}

void regression_free(Regression *regression) {
    for (int i = 0; i < regression->run_count; i++) regression_free_run(&regression->runs[i]);
    for (int i = 0; regression->frames != NULL && i < regression->count; i++) {
        free(regression->frames[i].read_error);
        free(regression->frames[i].changes);
    }
    free(regression->frames);
    free(regression->runs);
    free(regression->causes);
    shown_free(&regression->shown);
    rules_destroy(regression->rules);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) image_sequence_close(regression->sequences[side]);
    *regression = (Regression){0};
}
