/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs of both folders: which there are, and whether their states differ. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The limit of a trajectory file. */
static const size_t MAX_RUN_SIZE = (size_t)2 << 30;

static bool is_trace(const char *name) { return file_name_ends_with(name, ".csv"); }

Trajectory *regression_read_run(const char *path, Error *error) {
    return is_trace(path) ? csv_trace_read(path, error) : trajectory_read(path, error);
}

static bool is_run(const char *name) {
    return (file_name_ends_with(name, ".npz") || is_trace(name)) && name_is_text(name);
}

/* Adds a file of one folder. That the other folder has no such file is a failure, unless there are pictures: then the
   runs only explain them. */
static bool add_run(Regression *regression, RegressionSide side, const char *name, Error *error) {
    const RegressionSide other = side == EXPECTED ? ACTUAL : EXPECTED;
    char path[PATH_MAX];
    struct stat status;
    if (!name_is_text(name)) return true; /* of its folder */
    if (!file_path(path, sizeof path, error, "%s/%s", regression->sequences[other]->folder, name)) return false;
    const bool alone = stat(path, &status) != 0;
    if (alone && errno != ENOENT && errno != ENOTDIR)
        return error_system(error, path, "cannot be read: %s", strerror(errno));
    if (!alone && side == ACTUAL) return true; /* added with the expected one */
    if (alone && regression->count > 0) {
        regression->runs_left_out += side == EXPECTED;
        return true;
    }
    RegressionRun *run = &regression->runs[regression->run_count++];
    *run = (RegressionRun){.beyond = {.frame = -1},
                           .difference = {.equal = true, .frame = -1, .body = -1, .max_frame = -1, .max_body = -1}};
    run->alone[side] = alone;
    run->paths[other] = strdup(path);
    if (!file_path(path, sizeof path, error, "%s/%s", regression->sequences[side]->folder, name)) return false;
    run->paths[side] = strdup(path);
    run->name = strdup(name);
    return (run->name != NULL && run->paths[EXPECTED] != NULL && run->paths[ACTUAL] != NULL) ||
           error_memory(error, name);
}

static bool list_runs(Regression *regression, Error *error) {
    FolderList files[SIDES] = {{0}, {0}};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++)
        ok = folder_list(&files[side], regression->sequences[side]->folder, is_run, !regression->options.flat, error);
    regression->runs = calloc(files[EXPECTED].count + files[ACTUAL].count + 1, sizeof *regression->runs);
    ok = ok && (regression->runs != NULL || error_memory(error, "runs"));
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        for (size_t i = 0; ok && i < files[side].count; i++)
            ok = add_run(regression, side, files[side].names[i], error);
        folder_list_free(&files[side]);
    }
    return ok;
}

/* Marks the frames that differ; frames beyond the end of the shorter run do. Runs that differ, but whose poses are near
   enough, pass. */
static bool measure(RegressionRun *run, const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                    Error *error) {
    const int common = a->frames < b->frames ? a->frames : b->frames;
    char what[sizeof run->difference.what];
    const bool other_worlds = trajectory_different_worlds(a, b, what, sizeof what);
    trajectory_compare(a, b, &run->difference);
    memcpy(run->scene, a->scene, sizeof run->scene);
    memcpy(run->verdicts[EXPECTED], a->verdict, sizeof a->verdict);
    memcpy(run->verdicts[ACTUAL], b->verdict, sizeof b->verdict);
    if (run->difference.equal) return true;
    run->frames = a->frames > b->frames ? a->frames : b->frames;
    run->differs = malloc((size_t)run->frames * sizeof *run->differs);
    if (run->differs == NULL) return error_memory(error, run->name);
    for (int frame = 0; frame < run->frames; frame++) {
        run->differs[frame] = other_worlds || frame >= common;
        for (int body = 0; (body < a->bodies || body < b->bodies) && !run->differs[frame]; body++)
            run->differs[frame] = !trajectory_same_states(a, frame, b, frame, body);
    }
    TrajectoryParting parting;
    if (!tolerance->given || other_worlds) return true;
    if (!trajectory_part(a, b, tolerance, &parting, error)) return false;
    run->beyond = parting.beyond;
    run->within = parting.beyond.frame < 0 && a->frames == b->frames;
    return true;
}

/* *foreign: it is a trajectory in no folder. Equal bytes are equal runs, if they are a run; so is a run alone. */
static bool judge_run(const Regression *regression, RegressionRun *run, bool *foreign, Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (run->alone[1 - side]) continue;
        RegressionFile *file = &run->files[side];
        char *data = file_read(run->paths[side], MAX_RUN_SIZE, &file->size, error);
        if (data == NULL) return false;
        file->hash = hash_xxh3(data, file->size);
        bool pointer = !lfs_pointer_refuse(data, file->size, run->paths[side], error);
        free(data);
        if (pointer) return false;
    }
    const RegressionFile *a = &run->files[EXPECTED], *b = &run->files[ACTUAL];
    const bool alone = run->alone[EXPECTED] || run->alone[ACTUAL];
    const bool one = alone || (a->hash == b->hash && a->size == b->size);
    Error failures[SIDES] = {{0}, {0}};
    Trajectory *read[SIDES] = {NULL, NULL};
    bool system = false;
    *foreign = true;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (run->alone[1 - side] || (one && !alone && side == ACTUAL)) continue;
        read[side] = regression_read_run(run->paths[side], &failures[side]);
        *foreign = *foreign && read[side] == NULL;
        if (failures[side].kind == ERROR_SYSTEM) *error = failures[side], system = true;
    }
    bool ok = !system;
    if (ok && read[EXPECTED] != NULL && read[ACTUAL] != NULL)
        ok = measure(run, read[EXPECTED], read[ACTUAL], &regression->options.poses, error);
    else if (ok && !one && !*foreign)
        ok = false, *error = failures[read[EXPECTED] == NULL ? EXPECTED : ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(read[side]);
    return ok;
}

void regression_free_run(RegressionRun *run) {
    free(run->name);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) free(run->paths[side]);
    free(run->differs);
    free(run->read_error);
}

bool regression_find_runs(Regression *regression, Error *error) {
    if (regression->sequences[EXPECTED]->single) return true;
    if (!list_runs(regression, error)) return false;
    int kept = 0;
    bool ok = true;
    for (int i = 0; i < regression->run_count; i++) {
        bool foreign = false;
        RegressionRun run = regression->runs[i];
        Error why = {0};
        double begun = clock_seconds();
        if (ok && !judge_run(regression, &run, &foreign, &why)) { /* the others are compared */
            ok = why.kind == ERROR_INPUT && (run.read_error = strdup(why.message)) != NULL;
            if (!ok) *error = why;
        }
        run.seconds = clock_seconds() - begun;
        if (foreign) {
            regression->runs_foreign++;
            regression_free_run(&run);
        } else
            regression->runs[kept++] = run;
    }
    regression->run_count = kept;
    return ok;
}
