/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a report: makes its pictures, writes the pages of runs, then the four files. */
#include "regression/report.h"

#include "base/base.h"
#include "base/numbers.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "pictures/player.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/flip.h"
#include "regression/regression_internal.h"
#include "regression/regression.h"
#include "runs/trajectory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

const char report_kind_letters[REPORT_KINDS + 1] = "eadf";
enum { DIFFERENCE = SIDES, HEAT };

/* Loads a file and checks that it has not changed since the comparison. */
static bool report_load(const RegressionFrame *frame, RegressionSide side, ReportPicture *picture, Error *error) {
    const char *path = frame->at[side]->path;
    picture->data = image_load_png(path, &picture->size, error);
    if (picture->data == NULL) return false;
    return hash_xxh3(picture->data, picture->size) == frame->files[side].hash ||
           error_input(error, path, "has changed since the comparison");
}

/* Measures FLIP; draws its picture only if picture != NULL. */
static bool report_measure(const Image *expected, const Image *actual, RegressionFrame *frame, ReportPicture *picture,
                           Error *error) {
    IndexedPng *heat = NULL;
    FlipSummary flip;
    if (picture != NULL && (heat = heat_picture(expected->width, expected->height, error)) == NULL) return false;
    const FlipSink sink = heat_picture_sink(heat);
    bool ok = flip_compare(expected, actual, FLIP_PIXELS_PER_DEGREE, heat != NULL ? &sink : NULL, &flip, error);
    if (ok) frame->flip = flip.mean, frame->flip_p99 = flip.p99;
    if (ok && heat != NULL) ok = (picture->data = indexed_png_end(heat, &picture->size, error)) != NULL;
    indexed_png_destroy(heat);
    return ok;
}

/* Measures FLIP and, if there is room, draws the difference pictures. Of pictures of different size, the difference
   picture shows both, and FLIP the overlap. */
static bool report_draw(const Regression *regression, RegressionFrame *frame, Image *expected, Image *actual,
                        ReportPicture pictures[REPORT_KINDS], bool room, Error *error) {
    uint8_t *masked;
    int width = int_max(expected->width, actual->width), height = int_max(expected->height, actual->height);
    if (!regression_ignore(regression, frame, expected, actual, &masked, error)) return false;
    ReportPicture *difference = &pictures[DIFFERENCE];
    if (room) difference->data = difference_picture(expected, actual, masked, width, height, &difference->size, error);
    image_copy_masked(expected, actual, masked);
    bool ok = (!room || difference->data != NULL) &&
              report_measure(expected, actual, frame, room ? &pictures[HEAT] : NULL, error);
    free(masked);
    return ok;
}

/* Only for frames with two pictures whose pixels differ. */
static bool draw_differences(const Regression *regression, RegressionFrame *frame, ReportPicture pictures[REPORT_KINDS],
                             bool room, Error *error) {
    Image *images[SIDES] = {NULL, NULL};
    if (frame->pixels == PIXELS_EQUAL || frame->pixels > PIXELS_RESIZED || frame->sizes_alone) return true;
    assert(frame->at[EXPECTED] != NULL && frame->at[ACTUAL] != NULL);
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        images[side] = image_decode_png(pictures[side].data, pictures[side].size, frame->at[side]->path,
                                        regression->options.max_pixels, error);
    bool ok = images[EXPECTED] != NULL && images[ACTUAL] != NULL &&
              report_draw(regression, frame, images[EXPECTED], images[ACTUAL], pictures, room, error);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) image_destroy(images[side]);
    return ok;
}

static void drop(ReportPicture pictures[REPORT_KINDS]) {
    for (int kind = 0; kind < REPORT_KINDS; kind++) {
        free(pictures[kind].data);
        pictures[kind] = (ReportPicture){NULL, 0};
    }
}

enum { BATCH = 16 };

/* Frames whose pictures are made in parallel. */
typedef struct Batch {
    ReportPictures *pictures;
    Regression *regression;
    bool room;
    int wanted, done; /* frames of all batches */
    int count, frames[BATCH];
} Batch;

static bool make_frame(void *context, int i, Error *error) {
    const Batch *batch = context;
    RegressionFrame *frame = &batch->regression->frames[batch->frames[i]];
    ReportPicture *made = batch->pictures->frames[batch->frames[i]];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (frame->at[side] != NULL && !report_load(frame, side, &made[side], error)) return false;
    return draw_differences(batch->regression, frame, made, batch->room, error);
}

/* Keeps a frame's pictures if they fit into *left bytes of base64. Once some do not fit, *left is 0. */
static void keep_frame(ReportPictures *pictures, RegressionFrame *frame, int i, size_t *left) {
    ReportPicture *made = pictures->frames[i];
    size_t size = 0;
    for (int kind = 0; kind < REPORT_KINDS; kind++) size += (made[kind].size + 2) / 3 * 4;
    frame->shown = size > 0 && size <= *left;
    *left = frame->shown ? *left - size : 0;
    pictures->left_out += !frame->shown;
    if (!frame->shown) drop(made);
}

static bool make_batch(Batch *batch, size_t *left, const Progress *progress, Error *error) {
    const ParallelWork work = {make_frame, batch};
    batch->room = *left > 0;
    bool ok = parallel_for(&work, batch->count, "report", NULL, error);
    for (int k = 0; k < batch->count; k++)
        keep_frame(batch->pictures, &batch->regression->frames[batch->frames[k]], batch->frames[k], left);
    if (!ok) return false;
    batch->done += batch->count;
    batch->count = 0;
    if (!progress_report(progress, batch->done, batch->wanted)) return error_interrupted(error, "report", "stopped");
    return true;
}

/* First failures, then frames within tolerance. */
static bool is_wanted(const RegressionFrame *frame, bool failed) {
    if (frame->pixels == PIXELS_UNREAD) return false;
    return failed ? frame_failed(frame) : !frame_failed(frame) && frame->pixels == PIXELS_WITHIN;
}

static void free_pictures(ReportPictures *pictures) {
    for (int i = 0; pictures->frames != NULL && i < pictures->count; i++) drop(pictures->frames[i]);
    free(pictures->frames);
}

/* Fills the pictures, and `shown` and `flip` of the frames. On failure nothing needs to be freed. */
static bool gather_pictures(ReportPictures *pictures, Regression *regression, size_t max_bytes,
                            const Progress *progress, Error *error) {
    *pictures = (ReportPictures){.count = regression->count};
    pictures->frames = calloc((size_t)regression->count + 1, sizeof *pictures->frames);
    if (pictures->frames == NULL) return error_memory(error, "report");
    Batch batch = {.pictures = pictures, .regression = regression};
    bool ok = true;
    for (int i = 0; i < regression->count; i++) {
        RegressionFrame *frame = &regression->frames[i];
        if (frame->pixels == PIXELS_EQUAL) frame->flip = frame->flip_p99 = 0;
        batch.wanted += is_wanted(frame, true) || is_wanted(frame, false);
    }
    for (int failed = 1; failed >= 0; failed--)
        for (int i = 0; ok && i < regression->count; i++) {
            if (!is_wanted(&regression->frames[i], failed)) continue;
            batch.frames[batch.count++] = i;
            if (batch.count == BATCH) ok = make_batch(&batch, &max_bytes, progress, error);
        }
    ok = ok && make_batch(&batch, &max_bytes, progress, error);
    if (!ok) free_pictures(pictures);
    return ok;
}

/* The pages of runs that differ, beside the report. */

/* Of the states in a page. A page of longer runs shows the frames around the first difference. */
enum { STATE_BYTES = 8 << 20, FRAMES_BEFORE = 60 };

static bool read_runs(Trajectory *runs[SIDES], const RegressionRun *run, Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if ((runs[side] = trajectory_read(run->paths[side], error)) == NULL) return false;
    TrajectoryDifference now;
    trajectory_compare(runs[EXPECTED], runs[ACTUAL], &now);
    return (!now.equal && now.frame == run->difference.frame && now.body == run->difference.body) ||
           error_input(error, run->paths[ACTUAL], "has changed since the comparison");
}

/* "run-NAME.html", with the run's name without .npz as a file name; a second page of that name is "run-NAME-2.html". */
static void name_page(char name[REPORT_RUN_SIZE], const Regression *regression, const ReportLink *links, int index) {
    const char *run = regression->runs[index].name;
    char stem[REPORT_RUN_SIZE - 40];
    snprintf(stem, sizeof stem, "%.*s", (int)strlen(run) - 4, run);
    file_name_clean(stem);
    snprintf(name, REPORT_RUN_SIZE, "run-%s.html", stem);
    for (int i = 0, number = 2; i < index; i++)
        if (strncmp(links[i].text, name, strlen(name)) == 0) {
            snprintf(name, REPORT_RUN_SIZE, "run-%s-%d.html", stem, number++);
            i = -1;
        }
}

/* All frames if their states fit. */
static PlayerOptions choose_frames(const Trajectory *const runs[SIDES], int first) {
    const Trajectory *a = runs[EXPECTED], *b = runs[ACTUAL];
    const int frames = a->frames > b->frames ? a->frames : b->frames, bodies = a->bodies + b->bodies;
    const int room = STATE_BYTES / (int)(6 * sizeof(float)) / (bodies > 0 ? bodies : 1);
    PlayerOptions options = {.last = -1, .names = {"expected", "actual"}};
    if (frames <= room) return options;
    options.first = first > FRAMES_BEFORE ? first - FRAMES_BEFORE : 0;
    options.last = options.first + (room > FRAMES_BEFORE ? room : FRAMES_BEFORE + 1);
    if (options.last >= frames) options.last = frames - 1;
    return options;
}

bool report_write_run(const Trajectory *const runs[SIDES], int frame, int body, const char *folder, const char *name,
                      ReportLink *link, size_t *bytes, Error *error) {
    char path[PATH_MAX], moment[PLAYER_LINK_SIZE];
    const PlayerOptions options = choose_frames(runs, frame);
    PlayerResult result;
    if (!file_path(path, sizeof path, error, "%s/%s", folder, name) ||
        !player_write(runs, SIDES, &options, path, &result, error))
        return false;
    player_link(moment, frame > 0 ? frame * (double)runs[EXPECTED]->dt : 0, body);
    snprintf(link->text, sizeof link->text, "%s%s", name, moment);
    *bytes = (size_t)result.bytes;
    return true;
}

typedef struct Writing {
    ReportRuns *runs;
    const Regression *regression;
    const char *folder;
    size_t left; /* bytes */
} Writing;

static bool write_page(Writing *writing, int index, const Trajectory *const runs[SIDES], Error *error) {
    char name[REPORT_RUN_SIZE];
    size_t bytes;
    const RegressionRun *run = &writing->regression->runs[index];
    const bool beyond = run->beyond.frame >= 0; /* what fails, where a tolerance lets smaller differences pass */
    name_page(name, writing->regression, writing->runs->links, index);
    if (!report_write_run(runs, beyond ? run->beyond.frame : run->difference.frame,
                          beyond ? run->beyond.body : run->difference.body, writing->folder, name,
                          &writing->runs->links[index], &bytes, error))
        return false;
    writing->left = bytes < writing->left ? writing->left - bytes : 0;
    return true;
}

/* Runs of different time steps have no common moment: no page. */
static bool show_run(Writing *writing, int index, Error *error) {
    Trajectory *runs[SIDES] = {NULL, NULL};
    bool ok = read_runs(runs, &writing->regression->runs[index], error);
    if (ok && memcmp(&runs[EXPECTED]->dt, &runs[ACTUAL]->dt, sizeof(float)) == 0) {
        if (writing->left == 0)
            writing->runs->left_out++;
        else
            ok = write_page(writing, index, (const Trajectory *const *)runs, error);
    }
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(runs[side]);
    return ok;
}

/* Writes the pages into the folder, as long as they fit into max_bytes: both runs, opened at the first difference
   beyond the tolerance, or at the first one.
   ERROR_INPUT if a run has changed since the comparison. The caller frees runs->links, also on failure. */
static bool write_run_pages(ReportRuns *runs, const Regression *regression, const char *folder, size_t max_bytes,
                            const Progress *progress, Error *error) {
    *runs = (ReportRuns){.links = calloc((size_t)regression->run_count + 1, sizeof *runs->links)};
    if (runs->links == NULL) return error_memory(error, "report");
    Writing writing = {runs, regression, folder, max_bytes};
    for (int i = 0; i < regression->run_count; i++) {
        if (!progress_report(progress, i, regression->run_count)) return error_interrupted(error, "report", "stopped");
        if (!regression->runs[i].difference.equal && !show_run(&writing, i, error)) return false;
    }
    return true;
}

bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error) {
    ReportPictures pictures;
    ReportRuns runs = {0};
    if (!file_make_directory(folder, error) || !gather_pictures(&pictures, regression, max_bytes, progress, error))
        return false;
    const Report report = {regression, &pictures, &runs, folder};
    const RegressionText notes = regression_notes(regression);
    const ReportResults results = {.comparison = &report,
                                   .count = regression->count + regression->run_count,
                                   .failed = regression->failed + regression->run_failed,
                                   .notes = notes.text,
                                   .seconds = regression->seconds,
                                   .at = report_case,
                                   .write_page = report_write_page,
                                   .write_json = report_write_json};
    bool ok =
        write_run_pages(&runs, regression, folder, max_bytes, progress, error) && report_write(&results, folder, error);
    free(runs.links);
    free_pictures(&pictures);
    return ok;
}
