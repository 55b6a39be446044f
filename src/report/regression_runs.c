/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of runs that differ, beside the report. */
#include "common/file.h"
#include "report/regression_parts.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Of the states in a page. A page of longer runs shows the frames around the first difference. */
enum { STATE_BYTES = 8 << 20, FRAMES_BEFORE = 60 };

static bool read_runs(Trajectory *runs[SIDES], const Regression *regression, const RegressionRun *run, Error *error) {
    char path[PATH_MAX];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!file_path(path, sizeof path, error, "%s/%s", regression->sequences[side]->folder, run->name) ||
            (runs[side] = trajectory_read(path, error)) == NULL)
            return false;
    TrajectoryDifference now;
    trajectory_compare(runs[EXPECTED], runs[ACTUAL], &now);
    return (!now.equal && now.frame == run->difference.frame && now.body == run->difference.body) ||
           error_input(error, path, "has changed since the comparison");
}

typedef struct Stem {
    char text[REPORT_RUN_SIZE - 40];
} Stem;

/* The run's name, without .npz, as a file name. */
static Stem stem_of(const RegressionRun *run) {
    Stem stem;
    snprintf(stem.text, sizeof stem.text, "%.*s", (int)strlen(run->name) - 4, run->name);
    file_name_clean(stem.text);
    return stem;
}

/* "run-NAME.html"; a second run of that name gets "run-NAME-2.html". */
static void name_page(char name[REPORT_RUN_SIZE], const Regression *regression, int index) {
    const Stem stem = stem_of(&regression->runs[index]);
    char number[16] = "";
    int same = 1;
    for (int i = 0; i < index; i++) {
        const Stem other = stem_of(&regression->runs[i]);
        same += strcmp(stem.text, other.text) == 0;
    }
    if (same > 1) snprintf(number, sizeof number, "-%d", same);
    snprintf(name, REPORT_RUN_SIZE, "run-%s%s.html", stem.text, number);
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

typedef struct Writing {
    ReportRuns *runs;
    const Regression *regression;
    const char *folder;
    size_t left; /* bytes */
} Writing;

static bool write_page(Writing *writing, int index, const Trajectory *const runs[SIDES], Error *error) {
    char name[REPORT_RUN_SIZE], path[PATH_MAX], moment[PLAYER_LINK_SIZE];
    const TrajectoryDifference *difference = &writing->regression->runs[index].difference;
    const PlayerOptions options = choose_frames(runs, difference->frame);
    PlayerResult result;
    name_page(name, writing->regression, index);
    if (!file_path(path, sizeof path, error, "%s/%s", writing->folder, name) ||
        !player_write(runs, SIDES, &options, path, &result, error))
        return false;
    player_link(moment, difference->frame > 0 ? difference->frame * (double)runs[EXPECTED]->dt : 0, difference->body);
    snprintf(writing->runs->links[index], sizeof writing->runs->links[index], "%s%s", name, moment);
    writing->left = (size_t)result.bytes < writing->left ? writing->left - (size_t)result.bytes : 0;
    return true;
}

/* Runs of different time steps have no common moment: no page. */
static bool show_run(Writing *writing, int index, Error *error) {
    Trajectory *runs[SIDES] = {NULL, NULL};
    bool ok = read_runs(runs, writing->regression, &writing->regression->runs[index], error);
    if (ok && memcmp(&runs[EXPECTED]->dt, &runs[ACTUAL]->dt, sizeof(float)) == 0) {
        if (writing->left == 0)
            writing->runs->left_out++;
        else
            ok = write_page(writing, index, (const Trajectory *const *)runs, error);
    }
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(runs[side]);
    return ok;
}

static bool show_runs(Writing *writing, const Progress *progress, Error *error) {
    const int count = writing->regression->run_count;
    for (int i = 0; i < count; i++) {
        if (!progress_report(progress, i, count)) return error_interrupted(error, "report", "stopped");
        if (!writing->regression->runs[i].difference.equal && !show_run(writing, i, error)) return false;
    }
    return true;
}

bool report_runs_write(ReportRuns *runs, const Regression *regression, const char *folder, size_t max_bytes,
                       const Progress *progress, Error *error) {
    *runs = (ReportRuns){.links = calloc((size_t)regression->run_count + 1, sizeof *runs->links)};
    if (runs->links == NULL) return error_memory(error, "report");
    Writing writing = {runs, regression, folder, max_bytes};
    if (show_runs(&writing, progress, error)) return true;
    report_runs_free(runs);
    return false;
}

void report_runs_free(ReportRuns *runs) {
    free(runs->links);
    runs->links = NULL;
}
