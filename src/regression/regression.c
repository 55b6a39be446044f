/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares two folders: each frame with its accepted pictures, then what that means for the whole. */
#include "regression/regression.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "regression/image_compare.h"
#include "regression/limits.h"
#include "regression/mask.h"
#include "regression/regression_internal.h"
#include "regression/sequence.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rules first, then what the options give. */
static Tolerance tolerance_of(const Regression *regression, const RegressionFrame *frame) {
    Tolerance tolerance = {0};
    rules_override(regression->rules, frame_name(frame), &tolerance);
    tolerance_override(&tolerance, &regression->options.tolerance);
    return tolerance;
}

static bool has_masks(const Regression *regression, const RegressionFrame *frame) {
    const Mask *mask = regression->options.mask;
    return (mask != NULL && mask->count > 0) || rules_have_masks(regression->rules, frame_name(frame));
}

bool regression_ignore(const Regression *regression, const RegressionFrame *frame, Image *expected, Image *actual,
                       uint8_t **masked, Error *error) {
    const Mask *mask = regression->options.mask;
    const char *name = frame_name(frame), *path = frame->at[EXPECTED]->path;
    const bool masks = has_masks(regression, frame), edges = tolerance_of(regression, frame).antialias;
    const size_t width = (size_t)expected->width;
    *masked = NULL;
    if ((masks || edges) && (*masked = calloc(width * (size_t)expected->height, 1)) == NULL)
        return error_memory(error, name);
    bool ok = !masks || ((mask == NULL || mask_draw(mask, expected, path, *masked, error)) &&
                         rules_draw_masks(regression->rules, name, expected, path, *masked, error));
    image_cut_to_overlap(expected, actual);
    const size_t left = (size_t)expected->width;
    for (size_t y = 0; masks && left < width && y < (size_t)expected->height; y++)
        memmove(*masked + y * left, *masked + y * width, left);
    ok = ok && (!edges || antialias_mark(expected, actual, *masked, error));
    if (!ok) free(*masked), *masked = NULL;
    return ok;
}

/* Sets the verdict on pixels from the difference. */
static void decide(RegressionFrame *frame, const Tolerance *limits) {
    const ImageDifference *difference = &frame->difference;
    if (!difference->same_size)
        frame->pixels = PIXELS_RESIZED;
    else if (difference->pixels == 0)
        frame->pixels = difference->moved > 0 ? PIXELS_WITHIN : PIXELS_EQUAL;
    else
        frame->pixels = tolerance_holds(limits, difference) ? PIXELS_WITHIN : PIXELS_DIFFER;
}

/* Row by row, in little memory, where that is enough. *done: the files are read in pieces, have one size, and are
   sound. */

static bool begin_rows(void *context, int width, int height) {
    RowCompare *compare = context;
    return row_compare_begin(compare, width, height, compare->tolerance, compare->all_levels);
}

static uint8_t *place_row(void *context, int side, int y) {
    RowCompare *compare = context;
    return edge_rows_place(&compare->sides[side], y);
}

static void take_row(void *context, int y, const uint8_t *a, const uint8_t *b) { row_compare_row(context, y, a != b); }

static bool judge_rows(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], const Tolerance *limits,
                       bool named, bool *done, Error *error) {
    const RegressionFile *of = &frame->files[EXPECTED];
    uint8_t *const data[SIDES] = {files[EXPECTED].data, files[ACTUAL].data};
    RowCompare compare = {.tolerance = limits->tolerance};
    const RowSink sink = {begin_rows, place_row, take_row, &compare, ROWS_AROUND};
    uint8_t *all = named ? calloc((size_t)of->width, (size_t)of->height) : NULL;
    if (named && all == NULL) return error_memory(error, frame_name(frame));
    compare.all_levels = all;
    *done = png_files_scan(files, regression->count == 1, &sink);
    bool ok = compare.error.kind == ERROR_NONE;
    if (ok && *done && (ok = row_compare_end(&compare))) {
        frame->difference = compare.difference;
        decide(frame, limits);
        ok = compare.difference.equal || (regression_keep_regions(frame, &compare.regions, error) &&
                                          (!named || regression_name_changes(regression, frame, data, all, error)));
    }
    if (compare.error.kind != ERROR_NONE) *error = compare.error;
    row_compare_free(&compare);
    free(all);
    return ok;
}

static bool judge_images(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], Image *images[SIDES],
                         const Tolerance *limits, bool named, Error *error) {
    Image *expected = images[EXPECTED], *actual = images[ACTUAL];
    uint8_t *const data[SIDES] = {files[EXPECTED].data, files[ACTUAL].data};
    ImageDifference *difference = &frame->difference;
    ImageRegions regions;
    uint8_t *masked;
    const bool same_size = expected->width == actual->width && expected->height == actual->height;
    if (!regression_ignore(regression, frame, expected, actual, &masked, error)) return false;
    image_compare_masked(expected, actual, masked, limits->tolerance, difference);
    difference->same_size = same_size;
    difference->equal = difference->equal && same_size;
    bool ok = difference->counted > 0 || !same_size ||
              error_input(error, frame->at[EXPECTED]->path, "the masks hide all its pixels: nothing is compared");
    if (ok) decide(frame, limits);
    if (ok && difference->pixels > 0)
        ok = image_regions_find(expected, actual, masked, difference, &regions, error) &&
             regression_keep_regions(frame, &regions, error);
    if (ok && difference->pixels > 0 && same_size && named) {
        const size_t pixels = (size_t)expected->width * (size_t)expected->height;
        uint8_t *levels = malloc(pixels);
        ok = levels != NULL || error_memory(error, frame_name(frame));
        if (ok) (void)image_find_levels(expected, actual, masked, 0, pixels, levels);
        ok = ok && regression_name_changes(regression, frame, data, levels, error);
        free(levels);
    }
    free(masked);
    return ok;
}

/* Whether the overlap is so small a part of the larger picture that it says nothing; and decoding both would let a
   small file cost what the largest picture costs. */
static bool are_far(const RegressionFile *a, const RegressionFile *b) {
    const int64_t LEAST_PART = 16;
    const int64_t width = a->width < b->width ? a->width : b->width,
                  height = a->height < b->height ? a->height : b->height;
    const int64_t of_a = (int64_t)a->width * a->height, of_b = (int64_t)b->width * b->height;
    return width * height < (of_a > of_b ? of_a : of_b) / LEAST_PART;
}

static bool judge(Regression *regression, RegressionFrame *frame, PngFile files[SIDES], Error *error) {
    enum { MANY = 1 << 24 }; /* pixels */
    PngFile *const a = &files[EXPECTED], *const b = &files[ACTUAL];
    RegressionFile *const of_a = &frame->files[EXPECTED], *const of_b = &frame->files[ACTUAL];
    const Tolerance limits = tolerance_of(regression, frame);
    /* A missing or extra frame is decoded, too, to detect damage. Of others, what is read in pieces has been
       checked. */
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        PngFile *from = &files[side];
        int *width = &frame->files[side].width, *height = &frame->files[side].height;
        const bool alone = frame->at[1 - side] == NULL;
        if (frame->at[side] == NULL) continue;
        if (alone) frame->pixels = side == EXPECTED ? PIXELS_MISSING : PIXELS_EXTRA;
        if (alone && !png_file_check(from, error)) return false;
        if (alone || from->rows != NULL)
            (void)png_size(from->data, from->size, width, height);
        else if (!png_check(from->data, from->size, from->path, width, height, error))
            return false;
    }
    if (frame->pixels != PIXELS_EQUAL) return true;

    /* What the files tell without their pixels. */
    if (!regression_judge_states(regression, frame, (uint8_t *const[]){a->data, b->data}, &limits, error)) return false;
    frame->difference = (ImageDifference){.first_x = -1, .first_y = -1};
    const bool same = png_files_are_same(files);
    const Mask *mask = regression->options.mask;
    const double hidden = (mask == NULL ? 0 : mask_most_hidden(mask, of_a->width, of_a->height)) +
                          rules_most_hidden(regression->rules, frame_name(frame), of_a->width, of_a->height);
    if (same && hidden < (double)of_a->width * of_a->height) { /* else masks may hide everything: that is told now */
        frame->difference.equal = frame->difference.same_size = true;
        return true;
    }
    if (!same && !png_display_compare(a->data, a->size, b->data, b->size, &frame->metadata, error)) return false;
    frame->metadata_failed = regression->options.strict && frame->metadata.text[0] != '\0';
    if (!same && are_far(of_a, of_b)) {
        frame->pixels = PIXELS_RESIZED;
        frame->sizes_alone = true;
        return png_check_pixels(of_a->width, of_a->height, regression->options.max_pixels, a->path, error) &&
               png_check_pixels(of_b->width, of_b->height, regression->options.max_pixels, b->path, error);
    }

    const bool rows = !has_masks(regression, frame) && !limits.antialias;
    bool named = false, done = false;
    if (!regression_may_name(regression, frame, &named, error)) return false;
    if (rows && !judge_rows(regression, frame, files, &limits, named, &done, error)) return false;
    if (done) return true;
    /* Damage is found without memory for the pixels: where a common file has it, and where the pixels are many. */
    const bool found = a->damaged || b->damaged;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const int64_t pixels = (int64_t)frame->files[side].width * frame->files[side].height;
        if (rows && (found ? files[side].damaged : pixels >= MANY) && !png_file_check(&files[side], error))
            return false;
    }
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (!png_file_load(&files[side], error)) return false;
        frame->files[side].size = files[side].size;
    }
    Image *images[SIDES];
    bool ok =
        image_decode_png_pair((const uint8_t *const[]){a->data, b->data}, (const size_t[]){a->size, b->size},
                              (const char *const[]){a->path, b->path}, regression->options.max_pixels, images, error);
    ok = ok && judge_images(regression, frame, files, images, &limits, named, error);
    image_destroy_pair(images);
    return ok;
}

static bool compare_files(Regression *regression, RegressionFrame *frame, Error *error) {
    PngFile files[SIDES] = {{0}};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++) {
        if (frame->at[side] == NULL) continue;
        ok = png_file_open(&files[side], frame->at[side]->path, regression->options.max_pixels, error);
        frame->files[side] = (RegressionFile){.hash = files[side].hash, .size = files[side].size};
    }
    ok = ok && judge(regression, frame, files, error);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        frame->files[side].size = files[side].bytes;
        png_file_close(&files[side]);
    }
    return ok;
}

/* Sets what the frame's files alone tell: pixels, states, metadata, changes. Where several pictures are accepted, the
   first that passes counts, or else the closest. Thread-safe. ERROR_INPUT if a file cannot be read. */
static bool compare_accepted(Regression *regression, RegressionFrame *frame, Error *error) {
    const RegressionFrame fresh = *frame;
    if (!compare_files(regression, frame, error)) return false;
    for (const SequenceFrame *other = frame->base->next; other != NULL; other = other->next) {
        if (!frame_failed(frame)) { /* it is not needed, but damage is told */
            size_t size;
            int width, height;
            uint8_t *data = image_load_png(other->path, &size, error);
            const bool sound = data != NULL && png_check(data, size, other->path, &width, &height, error);
            free(data);
            if (!sound) return false;
            continue;
        }
        RegressionFrame attempt = fresh;
        attempt.at[EXPECTED] = other;
        const bool ok = compare_files(regression, &attempt, error);
        const ImageDifference *now = &attempt.difference, *best = &frame->difference;
        const bool closer = ok && (!frame_failed(&attempt)             ? true
                                   : now->same_size != best->same_size ? now->same_size
                                   : now->pixels != best->pixels       ? now->pixels < best->pixels
                                                                       : now->largest < best->largest);
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
    int count = 0;
    const char *why = NULL;
    for (int i = regression->count + regression->run_count - 1; i >= 0; i--) {
        const char *unread = regression_unread(regression, i);
        if (unread != NULL) why = unread, count++;
    }
    if (why == NULL) return true;
    error->kind = ERROR_INPUT;
    snprintf(error->message, sizeof error->message, "%s", why);
    if (count > 1) error_add(error, "\n(further files that cannot be compared: %d)", count - 1);
    return false;
}

const char *regression_unread(const Regression *regression, int i) {
    return i < regression->count ? regression->frames[i].read_error
                                 : regression->runs[i - regression->count].read_error;
}

bool frame_failed(const RegressionFrame *frame) {
    return frame->pixels >= PIXELS_DIFFER || frame->states_failed || frame->metadata_failed;
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

/* Sets STATES_DIFFER_ELSEWHERE (see StateVerdict) in the frames of one sequence. Missing and extra frames do not count;
   their names may have another stem. */
static bool judge_sequences(Regression *regression, Error *error) {
    RegressionFrame **paired = malloc(((size_t)regression->count + 1) * sizeof *paired);
    if (paired == NULL) return error_memory(error, "frames");
    int count = 0;
    for (int i = 0; i < regression->count; i++)
        if (regression->frames[i].pixels < PIXELS_MISSING) paired[count++] = &regression->frames[i];
    for (int first = 0, end = 0; first < count; first = end) {
        bool physics = false, same_framing = false;
        for (; end < count && (end == first || sequence_same(paired[first]->base, paired[end]->base)); end++) {
            const RegressionFrame *frame = paired[end];
            const bool same = frame->at[EXPECTED] == frame->base && frame->pixels == PIXELS_EQUAL;
            physics = physics || frame->run_differs || frame->states == STATES_DIFFER;
            same_framing = same_framing || (same && frame->states == STATES_EQUAL);
        }
        for (int i = first; physics && !same_framing && i < end; i++)
            if (paired[i]->states == STATES_EQUAL) paired[i]->states = STATES_DIFFER_ELSEWHERE;
    }
    free(paired);
    return true;
}

static void count(Regression *regression) {
    regression->first_renderer = regression->first_run = regression->first_metadata = -1;
    for (int i = 0; i < regression->count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        const bool pictures = frame->pixels == PIXELS_DIFFER || frame->pixels == PIXELS_RESIZED;
        const bool view = pictures && frame->other_view && frame->states != STATES_DIFFER;
        const bool renderer = pictures && !view && frame->states == STATES_EQUAL;
        const bool failed = frame_failed(frame),
                   equal = frame->pixels == PIXELS_EQUAL && frame->states != STATES_DIFFER;
        regression->by_verdict[frame->pixels > PIXELS_DIFFER ? frame->pixels
                               : failed                      ? PIXELS_DIFFER
                               : equal                       ? PIXELS_EQUAL
                                                             : PIXELS_WITHIN]++;
        regression->failed += failed;
        regression->physics += failed && frame->states == STATES_DIFFER;
        regression->view += view;
        regression->elsewhere += pictures && !view && frame->states == STATES_DIFFER_ELSEWHERE;
        if (renderer && !frame->alone && regression->first_renderer < 0) regression->first_renderer = i;
        regression->renderer += renderer;
        regression->unknown += pictures && !view && frame->states == STATES_UNKNOWN;
        if (frame->metadata.text[0] != '\0' && regression->metadata++ == 0) regression->first_metadata = i;
        regression->metadata_failed += frame->metadata_failed && !pictures && !frame->states_failed;
        regression->other_accepted += !failed && frame->at[EXPECTED] != frame->base;
    }
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *runs = regression->runs;
        regression->run_within += runs[i].within;
        if (!run_failed(&runs[i])) continue;
        regression->run_failed++;
        regression->runs_unread += runs[i].read_error != NULL;
        for (RegressionSide side = EXPECTED; side < SIDES; side++)
            regression->runs_alone[side] += runs[i].alone[side] && runs[i].read_error == NULL;
        if (runs[i].alone[EXPECTED] || runs[i].alone[ACTUAL] || runs[i].read_error != NULL) continue;
        int first = regression->first_run;
        if (first < 0 || (unsigned)runs[i].difference.frame < (unsigned)runs[first].difference.frame)
            regression->first_run = i;
    }
}

static bool pair_frames(Regression *regression, Error *error) {
    SequencePair *pairs =
        image_sequence_pair(regression->sequences[EXPECTED], regression->sequences[ACTUAL], &regression->count, error);
    if (pairs == NULL) return false;
    RegressionFrame *frames = regression->frames = calloc((size_t)regression->count + 1, sizeof *frames);
    for (int i = 0; frames != NULL && i < regression->count; i++)
        frames[i] =
            (RegressionFrame){.base = pairs[i].a != NULL ? pairs[i].a : pairs[i].b, .at = {pairs[i].a, pairs[i].b}};
    free(pairs);
    if (frames == NULL) return error_memory(error, "frames");
    for (int i = 0; i < regression->count; i++) {
        frames[i].alone = !(i > 0 && sequence_same(frames[i - 1].base, frames[i].base)) &&
                          !(i + 1 < regression->count && sequence_same(frames[i].base, frames[i + 1].base));
        regression->film = regression->film || !frames[i].alone;
    }
    return true;
}

/* Reads the rules that the options name, or RULES_NAME in the expected folder if it is there. Of folders, each rule
   must match a frame. */
static bool read_rules(Regression *regression, Error *error) {
    const ImageSequence *expected = regression->sequences[EXPECTED];
    char found[PATH_MAX];
    const char *path = regression->options.rules;
    if (path == NULL) {
        bool there;
        if (!file_path(found, sizeof found, error, "%s/%s", expected->folder, RULES_NAME) ||
            !file_find(found, &there, error))
            return false;
        if (!there) return true;
        path = found;
    }
    regression->rules = rules_read(path, error);
    if (regression->rules == NULL || expected->single) return regression->rules != NULL;
    const char **names = malloc(((size_t)regression->count + 1) * sizeof *names);
    if (names == NULL) return error_memory(error, "rules");
    for (int i = 0; i < regression->count; i++) names[i] = frame_name(&regression->frames[i]);
    bool ok = rules_check_names(regression->rules, names, regression->count, error);
    free(names);
    return ok;
}

static bool is_any(const char *name) { return (void)name, true; }

/* A folder without pictures is an error, not a difference, unless neither has any and trajectories are compared.
   Through a link or another spelling of the path, the same folder is a mistake; the same path twice is meant. */
static bool check_inputs(const Regression *regression, const char *const paths[SIDES], Error *error) {
    const ImageSequence *a = regression->sequences[EXPECTED], *b = regression->sequences[ACTUAL];
    const bool runs_alone = regression->count == 0 && regression->run_count > 0;
    if (a->device == b->device && a->inode == b->inode && strcmp(paths[EXPECTED], paths[ACTUAL]) != 0)
        return error_input(
            error, paths[ACTUAL],
            "is the same %s as %s: nothing would be compared; to compare it with itself, write one path twice",
            a->single ? "file" : "folder", paths[EXPECTED]);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        const char *pictures = side == EXPECTED ? "expected" : "actual";
        FolderList files;
        if (sequence->count > 0 || runs_alone) continue;
        const bool listed = folder_list(&files, sequence->folder, is_any, true, &(Error){0});
        const bool empty = listed && files.count == 0;
        if (listed) folder_list_free(&files);
        if (empty) return error_input(error, sequence->folder, "the folder of the %s pictures is empty", pictures);
        return error_input(error, sequence->folder,
                           "the folder of the %s pictures has no PNG files (such as frame_000000.png)%s", pictures,
                           sequence->skipped > 0 ? ", only its subfolders do" : "");
    }
    return true;
}

bool regression_run(Regression *regression, const char *expected, const char *actual, const RegressionOptions *options,
                    const Progress *progress, Error *error) {
    *regression = (Regression){.options = *options};
    PoseTolerance *poses = &regression->options.poses;
    const double begun = clock_seconds();
    const ParallelWork work = {compare_frame, regression};
    bool ok =
        (regression->sequences[EXPECTED] = image_sequence_open(expected, !options->flat, options->strict, error)) !=
            NULL &&
        (regression->sequences[ACTUAL] = image_sequence_open(actual, !options->flat, options->strict, error)) != NULL &&
        pair_frames(regression, error);
    poses->given = poses->given && (regression->count == 0 || (options->tolerance.given & LIMIT_TOLERANCE) == 0);
    ok = ok && regression_find_runs(regression, error) &&
         check_inputs(regression, (const char *const[]){expected, actual}, error) && read_rules(regression, error) &&
         parallel_for(&work, regression->count, actual, progress, error) && judge_sequences(regression, error);
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
