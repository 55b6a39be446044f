/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_states.h"

#include "common/array.h"
#include "common/clock.h"
#include "common/file.h"
#include "common/hash.h"
#include "trajectory/trajectory_states.h"

#include <dirent.h>
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

static bool is_file(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static bool is_run(const Regression *regression, const char *name) {
    size_t length = strlen(name);
    if (name[0] == '.' || length < 5 || strcmp(name + length - 4, ".npz") != 0 || !name_is_text(name)) return false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        char path[PATH_MAX];
        if (!run_path(regression, side, name, path, &(Error){0}) || !is_file(path)) return false;
    }
    return true;
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const RegressionRun *)a)->name, ((const RegressionRun *)b)->name);
}

static bool list_runs(Regression *regression, Error *error) {
    const char *folder = regression->sequences[EXPECTED]->folder;
    DIR *directory = opendir(folder);
    size_t capacity = 0;
    bool ok = directory != NULL || error_input(error, folder, "cannot be read");
    for (struct dirent *entry; ok && (entry = readdir(directory)) != NULL;) {
        if (!is_run(regression, entry->d_name)) continue;
        void *runs = regression->runs;
        ok = array_reserve(&runs, &capacity, (size_t)regression->run_count + 1, sizeof *regression->runs);
        regression->runs = runs;
        char *name = ok ? strdup(entry->d_name) : NULL;
        if (name != NULL) regression->runs[regression->run_count++] = (RegressionRun){.name = name};
        ok = name != NULL || error_memory(error, folder);
    }
    if (directory != NULL) closedir(directory);
    if (regression->run_count > 0)
        qsort(regression->runs, (size_t)regression->run_count, sizeof *regression->runs, by_name);
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
    bool ok = sides[EXPECTED] != NULL && sides[ACTUAL] != NULL;
    *foreign = sides[EXPECTED] == NULL && sides[ACTUAL] == NULL;
    if (ok) {
        trajectory_compare(sides[EXPECTED], sides[ACTUAL], &run->difference);
        memcpy(run->scene, sides[EXPECTED]->scene, sizeof run->scene);
        ok = run->difference.equal || mark_frames(run, sides[EXPECTED], sides[ACTUAL], error);
    } else if (!*foreign)
        *error = failures[sides[EXPECTED] == NULL ? EXPECTED : ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(sides[side]);
    return ok || *foreign;
}

static bool judge_run(const Regression *regression, RegressionRun *run, bool *foreign, Error *error) {
    char paths[SIDES][PATH_MAX];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (!run_path(regression, side, run->name, paths[side], error)) return false;
        RegressionFile *file = &run->files[side];
        char *data = file_read(paths[side], MAX_RUN_SIZE, &file->size, error);
        if (data == NULL) return false;
        file->hash = hash_xxh3(data, file->size);
        free(data);
    }
    *foreign = false;
    run->difference.equal = true;
    const RegressionFile *a = &run->files[EXPECTED], *b = &run->files[ACTUAL];
    return (a->hash == b->hash && a->size == b->size) || compare_run(run, paths, foreign, error);
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
        if (foreign)
            free(run.name);
        else
            regression->runs[kept++] = run;
    }
    regression->run_count = kept;
    return ok;
}

/* The texts of a picture. */
typedef struct Texts {
    char scene[TRAJECTORY_NAME_SIZE], frame[32], state[512];
} Texts;

static void read_texts(Texts *texts, const uint8_t *data, size_t size) {
    image_find_text(data, size, "Scene", texts->scene, sizeof texts->scene);
    image_find_text(data, size, "Frame", texts->frame, sizeof texts->frame);
    image_find_text(data, size, "State", texts->state, sizeof texts->state);
}

/* The first differing panel: "a1 | b2" and "a1 | c3" give 2. */
static int first_panel(const char *a, const char *b) {
    int panel = 1;
    for (; *a != '\0' && *a == *b; a++, b++) panel += *a == '|';
    return panel;
}

/* Whether a run of the picture's scene (of any scene if the picture names none) differs in this frame. *somewhere: in
   any frame. */
static bool runs_differ(const Regression *regression, const Texts *texts, int64_t frame, bool *somewhere) {
    bool here = false;
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        if (run->differs == NULL || (texts->scene[0] != '\0' && strcmp(texts->scene, run->scene) != 0)) continue;
        int64_t at = frame < run->frames ? frame : run->frames - 1;
        here = here || run->differs[at < 0 ? 0 : at];
        *somewhere = true;
    }
    return here;
}

void regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES]) {
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        read_texts(&texts[side], data[side], frame->files[side].size);
    const char *a = texts[EXPECTED].state, *b = texts[ACTUAL].state;
    bool have_texts = a[0] != '\0' && b[0] != '\0', texts_differ = have_texts && strcmp(a, b) != 0;
    if (texts_differ) frame->panel = first_panel(a, b);
    const char *number = texts[EXPECTED].frame;
    int64_t at = number[0] >= '0' && number[0] <= '9' ? strtoll(number, NULL, 10) : frame->at[EXPECTED]->number;
    bool differs = runs_differ(regression, &texts[EXPECTED], at, &frame->run_differs);
    if (texts_differ || differs)
        frame->states = STATES_DIFFER;
    else
        frame->states = have_texts || regression->run_count > 0 ? STATES_EQUAL : STATES_UNKNOWN;
}
