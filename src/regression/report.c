/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a report: makes its pictures, writes the pages of runs, then the files. */
#include "regression/report.h"

#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "pictures/player.h"
#include "pixels/png.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void drop(ReportPicture pictures[REPORT_KINDS]) {
    for (int kind = 0; kind < REPORT_KINDS; kind++) {
        free(pictures[kind].data);
        pictures[kind] = (ReportPicture){NULL, 0};
    }
}

enum { BATCH = 16, DIFFERENCE = SIDES };

/* Frames whose pictures are made in parallel. */
typedef struct Batch {
    Report *report;
    Regression *regression;
    size_t left; /* bytes of base64; once some pictures do not fit, 0 */
    int count, frames[BATCH];
} Batch;

/* Loads the files, which must not have changed since the comparison, and draws the difference if there is room. */
static bool make_frame(void *context, int i, Error *error) {
    const Batch *batch = context;
    const Regression *regression = batch->regression;
    const RegressionFrame *frame = &regression->frames[batch->frames[i]];
    ReportPicture *made = batch->report->pictures[batch->frames[i]], *difference = &made[DIFFERENCE];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (frame->at[side] == NULL) continue;
        const char *path = frame->at[side]->path;
        if ((made[side].data = image_load_png(path, &made[side].size, error)) == NULL) return false;
        if (hash_xxh3(made[side].data, made[side].size) != frame->files[side].hash)
            return error_input(error, path, "has changed since the comparison");
    }
    if (frame->pixels == PIXELS_EQUAL || frame->pixels > PIXELS_RESIZED || frame->sizes_alone || batch->left == 0)
        return true;
    Image *images[SIDES] = {NULL, NULL};
    for (RegressionSide side = EXPECTED; side < SIDES && frame->at[side] != NULL; side++)
        images[side] = image_decode_png(made[side].data, made[side].size, frame->at[side]->path,
                                        regression->options.max_pixels, error);
    Image *const expected = images[EXPECTED], *const actual = images[ACTUAL];
    bool ok = expected != NULL && actual != NULL;
    if (ok) { /* of pictures of different size, both are shown */
        const int width = int_max(expected->width, actual->width), height = int_max(expected->height, actual->height);
        uint8_t *masked = NULL;
        ok = regression_ignore(regression, frame, expected, actual, &masked, error) &&
             (difference->data =
                  difference_picture(expected, actual, masked, width, height, &difference->size, error)) != NULL;
        free(masked);
    }
    image_destroy(expected);
    image_destroy(actual);
    return ok;
}

/* Keeps the pictures of a batch that fit. */
static bool make_batch(Batch *batch, Error *error) {
    const ParallelWork work = {make_frame, batch};
    const bool ok = parallel_for(&work, batch->count, "report", NULL, error);
    for (int k = 0; k < batch->count; k++) {
        RegressionFrame *frame = &batch->regression->frames[batch->frames[k]];
        ReportPicture *made = batch->report->pictures[batch->frames[k]];
        size_t size = 0;
        for (int kind = 0; kind < REPORT_KINDS; kind++) size += (made[kind].size + 2) / 3 * 4;
        frame->shown = size > 0 && size <= batch->left;
        batch->left = frame->shown ? batch->left - size : 0;
        batch->report->pictures_left_out += !frame->shown;
        if (!frame->shown) drop(made);
    }
    batch->count = 0;
    return ok;
}

static bool is_wanted(const RegressionFrame *frame, bool failed) {
    if (frame->pixels == PIXELS_UNREAD) return false;
    return failed ? frame_failed(frame) : !frame_failed(frame) && frame->pixels == PIXELS_WITHIN;
}

/* Makes the pictures of failures, then of frames within tolerance; sets `shown` of the frames. */
static bool gather_pictures(Report *report, Regression *regression, size_t max_bytes, const Progress *progress,
                            Error *error) {
    Batch batch = {.report = report, .regression = regression, .left = max_bytes};
    int wanted = 0, done = 0;
    for (int i = 0; i < regression->count; i++)
        wanted += is_wanted(&regression->frames[i], true) || is_wanted(&regression->frames[i], false);
    for (int failed = 1; failed >= 0; failed--)
        for (int i = 0; i < regression->count; i++) {
            if (!is_wanted(&regression->frames[i], failed)) continue;
            batch.frames[batch.count++] = i;
            if (++done < wanted && batch.count < BATCH) continue;
            if (!make_batch(&batch, error)) return false;
            if (!progress_report(progress, done, wanted)) return error_interrupted(error, "report", "stopped");
        }
    return true;
}

/* The pages of runs that differ, beside the report. */

/* Of the states in a page. A page of longer runs shows the frames around the first difference. */
enum { STATE_BYTES = 8 << 20, FRAMES_BEFORE = 60 };

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

/* What traces do not state, but a picture needs: a step, and sizes. Bodies become squares, as many of which would fill
   a quarter of a square as wide as what they span in all frames of the first run. */
static void show_traces(Trajectory *const runs[SIDES]) {
    const Trajectory *first = runs[EXPECTED];
    Vec2 low = vec2(INFINITY, INFINITY), high = vec2(-INFINITY, -INFINITY);
    for (size_t i = 0; i < (size_t)first->frames * (size_t)first->bodies; i++) { /* NaN is neither low nor high */
        const Vec2 at = first->position[i];
        low = vec2(fminf(low.x, at.x), fminf(low.y, at.y));
        high = vec2(fmaxf(high.x, at.x), fmaxf(high.y, at.y));
    }
    const float span = fmaxf(high.x - low.x, high.y - low.y) / (2 * sqrtf((float)first->bodies));
    const float dt = fmaxf(runs[EXPECTED]->dt, runs[ACTUAL]->dt), side = span > 0 && isfinite(span) ? span : 1;
    for (int i = 0; i < SIDES * first->bodies; i++) {
        Trajectory *run = runs[i % SIDES];
        run->dt = dt > 0 ? dt : 1.0F / 60;
        if (!(run->size[i / SIDES].x > 0)) run->size[i / SIDES] = vec2(side, side);
    }
}

/* Runs of different steps have no common moment, and hashes no pose. */
static bool can_play(const Trajectory *a, const Trajectory *b) {
    const bool traces = a->there != NULL || b->there != NULL;
    return !trajectory_different_steps(a, b) && !a->no_poses && !b->no_poses && !(traces && a->bodies != b->bodies);
}

bool report_write_run(Trajectory *const runs[SIDES], int frame, int body, const char *folder, const char *name,
                      ReportLink *link, size_t *bytes, Error *error) {
    const Trajectory *a = runs[EXPECTED], *b = runs[ACTUAL];
    *bytes = 0;
    if (!can_play(a, b)) return true;
    if (a->there != NULL || b->there != NULL) show_traces(runs);
    const int frames = a->frames > b->frames ? a->frames : b->frames, bodies = a->bodies + b->bodies;
    const int room = STATE_BYTES / (int)(6 * sizeof(float)) / (bodies > 0 ? bodies : 1);
    char path[PATH_MAX], moment[PLAYER_LINK_SIZE];
    PlayerOptions options = {.last = -1, .names = {"expected", "actual"}};
    PlayerResult result;
    if (frames > room) {
        options.first = frame > FRAMES_BEFORE ? frame - FRAMES_BEFORE : 0;
        options.last = options.first + (room > FRAMES_BEFORE ? room : FRAMES_BEFORE + 1);
        if (options.last >= frames) options.last = frames - 1;
    }
    if (!file_path(path, sizeof path, error, "%s/%s", folder, name) ||
        !player_write((const Trajectory *const *)runs, SIDES, &options, path, &result, error))
        return false;
    player_link(moment, frame > 0 ? frame * (double)a->dt : 0, body);
    snprintf(link->text, sizeof link->text, "%s%s", name, moment);
    *bytes = (size_t)result.bytes;
    return true;
}

/* Writes a page of both runs, opened at the first difference beyond the tolerance, or at the first one, if there are
   bytes left for it. */
static bool write_run(Report *report, int index, size_t *left, Error *error) {
    const RegressionRun *run = &report->regression->runs[index];
    const bool beyond = run->beyond.frame >= 0; /* what fails, where a tolerance lets smaller differences pass */
    Trajectory *runs[SIDES] = {NULL, NULL};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++)
        ok = (runs[side] = regression_read_run(run->paths[side], error)) != NULL;
    if (ok) {
        TrajectoryDifference now;
        trajectory_compare(runs[EXPECTED], runs[ACTUAL], &now);
        ok = (!now.equal && now.frame == run->difference.frame && now.body == run->difference.body) ||
             error_input(error, run->paths[ACTUAL], "has changed since the comparison");
    }
    if (ok && can_play(runs[EXPECTED], runs[ACTUAL])) {
        char name[REPORT_RUN_SIZE];
        size_t bytes = 0;
        report->runs_left_out += *left == 0;
        if (*left > 0) {
            name_page(name, report->regression, report->links, index);
            ok = report_write_run(runs, beyond ? run->beyond.frame : run->difference.frame,
                                  beyond ? run->beyond.body : run->difference.body, report->folder, name,
                                  &report->links[index], &bytes, error);
        }
        *left = bytes < *left ? *left - bytes : 0;
    }
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(runs[side]);
    return ok;
}

bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error) {
    const RegressionText notes = regression_notes(regression);
    Report report = {.regression = regression,
                     .folder = folder,
                     .pictures = calloc((size_t)regression->count + 1, sizeof *report.pictures),
                     .links = calloc((size_t)regression->run_count + 1, sizeof *report.links)};
    const ReportResults results = {.comparison = &report,
                                   .count = regression->count + regression->run_count,
                                   .failed = regression->failed + regression->run_failed,
                                   .notes = notes.text,
                                   .seconds = regression->seconds,
                                   .at = report_case,
                                   .write_page = report_write_page,
                                   .write_json = report_write_json};
    size_t left = max_bytes; /* for the pages of runs */
    bool ok = (report.pictures != NULL && report.links != NULL) || error_memory(error, "report");
    ok = ok && gather_pictures(&report, regression, max_bytes, progress, error);
    for (int i = 0; ok && i < regression->run_count; i++) {
        ok = progress_report(progress, i, regression->run_count) || error_interrupted(error, "report", "stopped");
        if (ok && !regression->runs[i].difference.equal && regression->runs[i].read_error == NULL)
            ok = write_run(&report, i, &left, error);
    }
    ok = ok && report_write(&results, folder, error);
    for (int i = 0; report.pictures != NULL && i < regression->count; i++) drop(report.pictures[i]);
    free(report.pictures);
    free(report.links);
    return ok;
}
