/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression_states.h"

#include "common/clock.h"
#include "common/file.h"
#include "common/folder.h"
#include "common/hash.h"
#include "common/lfs_pointer.h"
#include "trajectory/trajectory_states.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The limit of a trajectory file. */
static const size_t MAX_RUN_SIZE = (size_t)2 << 30;

static bool run_path(const Regression *regression, RegressionSide side, const char *name, char path[PATH_MAX],
                     Error *error) {
    return file_path(path, PATH_MAX, error, "%s/%s", regression->sequences[side]->folder, name);
}

static bool is_run(const char *name) {
    size_t length = strlen(name);
    return length >= 5 && strcmp(name + length - 4, ".npz") == 0 && name_is_text(name);
}

/* Adds a file of the expected folder if the actual folder has it, too. */
static bool add_run(Regression *regression, const char *name, Error *error) {
    char path[PATH_MAX];
    struct stat status;
    if (!name_is_text(name)) return true; /* of its folder */
    if (!run_path(regression, ACTUAL, name, path, error)) return false;
    if (stat(path, &status) != 0) {
        if (errno != ENOENT && errno != ENOTDIR)
            return error_system(error, path, "cannot be read: %s", strerror(errno));
        regression->runs_left_out++;
        return true;
    }
    char *copy = strdup(name);
    if (copy == NULL) return error_memory(error, name);
    regression->runs[regression->run_count++] = (RegressionRun){.name = copy};
    return true;
}

static bool list_runs(Regression *regression, Error *error) {
    const char *folder = regression->sequences[EXPECTED]->folder;
    FolderList files;
    if (!folder_list(&files, folder, is_run, !regression->options.flat, error)) return false;
    regression->runs = calloc(files.count + 1, sizeof *regression->runs);
    bool ok = regression->runs != NULL || error_memory(error, folder);
    for (size_t i = 0; ok && i < files.count; i++) ok = add_run(regression, files.names[i], error);
    folder_list_free(&files);
    return ok;
}

/* Marks the frames that differ; frames beyond the end of the shorter run do. */
static bool mark_frames(RegressionRun *run, const Trajectory *a, const Trajectory *b, Error *error) {
    int common = a->frames < b->frames ? a->frames : b->frames;
    char what[sizeof run->difference.what];
    bool other_worlds = trajectory_different_worlds(a, b, what, sizeof what);
    run->frames = a->frames > b->frames ? a->frames : b->frames;
    run->differs = malloc((size_t)run->frames * sizeof *run->differs);
    if (run->differs == NULL) return error_memory(error, run->name);
    for (int frame = 0; frame < run->frames; frame++) {
        run->differs[frame] = other_worlds || frame >= common;
        for (int body = 0; body < a->bodies && !run->differs[frame]; body++)
            run->differs[frame] = !trajectory_same_state(a, b, frame, body);
    }
    return true;
}

static bool compare_run(RegressionRun *run, char paths[SIDES][PATH_MAX], bool *foreign, Error *error) {
    Error failures[SIDES] = {{0}, {0}};
    Trajectory *sides[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        sides[side] = trajectory_read(paths[side], &failures[side]);
    bool ok = sides[EXPECTED] != NULL && sides[ACTUAL] != NULL, system = false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (failures[side].kind == ERROR_SYSTEM) *error = failures[side], system = true;
    *foreign = !system && sides[EXPECTED] == NULL && sides[ACTUAL] == NULL;
    if (ok) {
        trajectory_compare(sides[EXPECTED], sides[ACTUAL], &run->difference);
        memcpy(run->scene, sides[EXPECTED]->scene, sizeof run->scene);
        ok = run->difference.equal || mark_frames(run, sides[EXPECTED], sides[ACTUAL], error);
    } else if (!*foreign && !system)
        *error = failures[sides[EXPECTED] == NULL ? EXPECTED : ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(sides[side]);
    return ok || *foreign;
}

/* Equal bytes are equal runs, if they are a run. */
static bool read_run(RegressionRun *run, const char *path, bool *foreign, Error *error) {
    Error failure = {0};
    Trajectory *trajectory = trajectory_read(path, &failure);
    *foreign = trajectory == NULL;
    trajectory_destroy(trajectory);
    run->difference.equal = true;
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind != ERROR_SYSTEM;
}

static bool judge_run(const Regression *regression, RegressionRun *run, bool *foreign, Error *error) {
    char paths[SIDES][PATH_MAX];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (!run_path(regression, side, run->name, paths[side], error)) return false;
        RegressionFile *file = &run->files[side];
        char *data = file_read(paths[side], MAX_RUN_SIZE, &file->size, error);
        if (data == NULL) return false;
        file->hash = hash_xxh3(data, file->size);
        bool pointer = !lfs_pointer_refuse(data, file->size, paths[side], error);
        free(data);
        if (pointer) return false;
    }
    const RegressionFile *a = &run->files[EXPECTED], *b = &run->files[ACTUAL];
    bool same = a->hash == b->hash && a->size == b->size;
    return same ? read_run(run, paths[EXPECTED], foreign, error) : compare_run(run, paths, foreign, error);
}

bool regression_find_runs(Regression *regression, Error *error) {
    if (regression->sequences[EXPECTED]->single) return true;
    if (!list_runs(regression, error)) return false;
    int kept = 0;
    bool ok = true;
    for (int i = 0; i < regression->run_count; i++) {
        bool foreign = false;
        RegressionRun run = regression->runs[i];
        double begun = clock_seconds();
        ok = ok && judge_run(regression, &run, &foreign, error);
        run.seconds = clock_seconds() - begun;
        if (foreign) {
            regression->runs_foreign++;
            free(run.name);
        } else
            regression->runs[kept++] = run;
    }
    regression->run_count = kept;
    return ok;
}

/* The texts of a picture. */
typedef struct Texts {
    char scene[TRAJECTORY_NAME_SIZE], frame[32], state[512];
} Texts;

static bool read_texts(Texts *texts, const uint8_t *data, size_t size, Error *error) {
    return image_find_text(data, size, "Scene", texts->scene, sizeof texts->scene, error) &&
           image_find_text(data, size, "Frame", texts->frame, sizeof texts->frame, error) &&
           image_find_text(data, size, "State", texts->state, sizeof texts->state, error);
}

/* The first differing panel: "a1 | b2" and "a1 | c3" give 2. */
static int first_panel(const char *a, const char *b) {
    int panel = 1;
    for (; *a != '\0' && *a == *b; a++, b++) panel += *a == '|';
    return panel;
}

static bool in_its_folder(const RegressionRun *run, const SequenceFrame *picture) {
    return file_folder_length(run->name) == (size_t)picture->folder &&
           memcmp(run->name, picture->name, (size_t)picture->folder) == 0;
}

/* Whether a run of the picture's folder and scene (of any scene if the picture names none) differs in this frame.
   *somewhere: in any frame. */
static bool runs_differ(const Regression *regression, const SequenceFrame *picture, const Texts *texts, int64_t frame,
                        bool *somewhere) {
    bool here = false;
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        if (run->differs == NULL || !in_its_folder(run, picture) ||
            (texts->scene[0] != '\0' && strcmp(texts->scene, run->scene) != 0))
            continue;
        int64_t at = frame < run->frames ? frame : run->frames - 1;
        here = here || run->differs[at < 0 ? 0 : at];
        *somewhere = true;
    }
    return here;
}

static bool has_runs(const Regression *regression, const SequenceFrame *picture) {
    for (int i = 0; i < regression->run_count; i++)
        if (in_its_folder(&regression->runs[i], picture)) return true;
    return false;
}

bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             Error *error) {
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    const char *a = texts[EXPECTED].state, *b = texts[ACTUAL].state;
    bool have_texts = a[0] != '\0' && b[0] != '\0', texts_differ = have_texts && strcmp(a, b) != 0;
    if (texts_differ) frame->panel = first_panel(a, b);
    const char *number = texts[EXPECTED].frame;
    int64_t at = number[0] >= '0' && number[0] <= '9' ? strtoll(number, NULL, 10) : frame->base->number;
    bool differs = runs_differ(regression, frame->base, &texts[EXPECTED], at, &frame->run_differs);
    bool known = have_texts || has_runs(regression, frame->base);
    frame->states = texts_differ || differs ? STATES_DIFFER : known ? STATES_EQUAL : STATES_UNKNOWN;
    return true;
}
