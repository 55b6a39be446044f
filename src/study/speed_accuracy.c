/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/speed_accuracy.h"

#include "common/folder_reserve.h"
#include "common/parallel.h"
#include "study/part_file.h"
#include "study/scene_study.h"
#include "study/study_key.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* On two cores, the full study of three scenes takes some minutes, the quick one less than one. */
static const StudySize full_size = {.launches = 40,
                                    .closed = {.after = 6, .rest = 30},
                                    .frozen = {.after = 6, .rest = 60},
                                    .timed_launches = 20,
                                    .repetitions = 3};
static const StudySize quick_size = {.launches = 5,
                                     .closed = {.after = 20, .rest = 120},
                                     .frozen = {.after = 20, .rest = 120},
                                     .timed_launches = 1,
                                     .repetitions = 3};

const StudySize *speed_accuracy_size(bool quick) { return quick ? &quick_size : &full_size; }

typedef struct Run {
    const SpeedAccuracyOptions *options;
    const StageProgress *progress;
    ContenderList contenders;
    PartFile part;
    ChartRow *rows; /* of the finished scenes, followed by those of the current scene */
    int row_count;  /* of the finished scenes */
    SceneStudy study;
    bool *scored; /* [contenders] of the current scene */
} Run;

static const Progress *begin_stage(const Run *run, const char *what) {
    if (run->progress == NULL) return NULL;
    char title[CHART_NAME_SIZE + 64];
    snprintf(title, sizeof title, "%s: %s", run->study.scene->name, what);
    return run->progress->begin(run->progress->context, title);
}

static ChartRow *rows_of(const Run *run, int contender) { return run->rows + run->row_count + contender * ROWS_EACH; }

/* Saves the rows of the finished scenes and of the contenders scored in the current one. */
static bool save_checkpoint(const Run *run, Error *error) {
    int count = run->row_count;
    size_t most = (size_t)run->row_count + (size_t)run->study.contender_count * ROWS_EACH;
    ChartRow *done = malloc((most + 1) * sizeof *done);
    if (done == NULL) return error_memory(error, "study");
    if (count > 0) memcpy(done, run->rows, (size_t)count * sizeof *done);
    for (int i = 0; i < run->study.contender_count; i++) {
        if (!run->scored[i]) continue;
        memcpy(done + count, rows_of(run, i), ROWS_EACH * sizeof *done);
        count += ROWS_EACH;
    }
    bool ok = part_file_write(&run->part, done, count, error);
    free(done);
    return ok;
}

static bool score(void *context, int i, Error *error) {
    Run *run = context;
    bool ok = true;
    if (run->scored[i]) return true;
    if (!scene_study_score(&run->study, i, rows_of(run, i), error)) return false;
#pragma omp critical(study_part)
    {
        run->scored[i] = true;
        ok = save_checkpoint(run, error);
    }
    return ok;
}

/* Restores the scores of an interrupted study. True if all costs are known too. */
static bool restore_checkpoint(Run *run) {
    bool timed = true;
    for (int i = 0; i < run->study.contender_count; i++) {
        ChartRow *rows = rows_of(run, i);
        *rows = (ChartRow){.scene = run->study.scene->name,
                           .method = run->study.contenders[i]->name,
                           .setting = run->study.contenders[i]->setting};
        run->scored[i] = part_file_find(&run->part, rows, ROWS_EACH);
        timed &= run->scored[i] && !isnan(rows[PROTOCOL_CLOSED * PHASES + PHASE_REST].us_solver);
    }
    return timed;
}

static bool measure_scene(Run *run, Error *error) {
    SceneStudy *study = &run->study;
    if (restore_checkpoint(run)) return true;
    const ParallelWork work = {score, run};
    return scene_study_prepare(study, begin_stage(run, "converged runs"), error) &&
           parallel_for(&work, study->contender_count, study->scene->name, begin_stage(run, "scores"), error) &&
           scene_study_time(study, rows_of(run, 0), begin_stage(run, "times"), error) && save_checkpoint(run, error);
}

static bool add_scene(Run *run, const char *path, SpeedAccuracyScene *summary, Error *error) {
    const StudySize *size = speed_accuracy_size(run->options->quick);
    if (!scene_study_begin(&run->study, path, &run->contenders, &run->options->launches, size, error)) return false;
    for (int i = 0; i < run->row_count; i++)
        if (strcmp(run->rows[i].scene, run->study.scene->name) == 0) {
            scene_study_end(&run->study);
            return error_input(error, path, "another scene has the same name (%s)", run->rows[i].scene);
        }
    int count = run->study.contender_count;
    size_t rows = (size_t)run->row_count + (size_t)count * ROWS_EACH;
    ChartRow *grown = realloc(run->rows, (rows + 1) * sizeof *grown);
    if (grown != NULL) run->rows = grown;
    run->scored = calloc((size_t)count + 1, sizeof *run->scored);
    bool ok = grown != NULL && run->scored != NULL;
    if (!ok) error_memory(error, "study");
    ok = ok && measure_scene(run, error);
    if (ok) {
        *summary =
            (SpeedAccuracyScene){.contenders = count,
                                 .launches = run->study.launch_count,
                                 .without_network = contenders_without_network(&run->contenders, run->study.scene),
                                 .frozen_residual = run->study.frozen_residual,
                                 .solves = run->study.solves,
                                 .unconverged = run->study.unconverged};
        snprintf(summary->name, sizeof summary->name, "%s", run->study.scene->name);
        /* The scene ends here, its rows do not. */
        for (size_t i = (size_t)run->row_count; i < rows; i++) run->rows[i].scene = summary->name;
        run->row_count = (int)rows;
    }
    free(run->scored);
    run->scored = NULL;
    scene_study_end(&run->study);
    return ok;
}

/* A missing network is an error only of the method that needs it. */
static bool add_scene_to_key(uint64_t *key, const char *path, Error *error) {
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

/* Hashes everything that determines the result: the program, the options and the files. */
static bool study_key(const SpeedAccuracyOptions *options, uint64_t *key, Error *error) {
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, &options->quick, sizeof options->quick);
    if (options->methods != NULL) study_key_add(key, options->methods, strlen(options->methods));
    const LaunchChoice *launches = &options->launches;
    study_key_add(key, &launches->count, sizeof launches->count);
    study_key_add(key, &launches->bomb_x.count, sizeof launches->bomb_x.count);
    study_key_add(key, &launches->bomb_x.first, sizeof launches->bomb_x.first);
    study_key_add(key, &launches->bomb_x.step, sizeof launches->bomb_x.step);
    if (launches->table != NULL && !study_key_add_file(key, launches->table, error)) return false;
    for (int i = 0; i < options->scene_count; i++)
        if (!add_scene_to_key(key, options->scenes[i], error)) return false;
    return true;
}

static bool run_scenes(Run *run, SpeedAccuracyScene *scenes, Error *error) {
    char path[CSV_PATH_SIZE];
    if (!csv_table_path(path, run->options->folder, &chart_layout, error)) return false;
    for (int i = 0; i < run->options->scene_count; i++)
        if (!add_scene(run, run->options->scenes[i], &scenes[i], error)) return false;
    return csv_table_write(path, &chart_layout, run->rows, run->row_count, error);
}

bool speed_accuracy_run(const SpeedAccuracyOptions *options, const StageProgress *progress, SpeedAccuracyScene *scenes,
                        Error *error) {
    Run run = {.options = options, .progress = progress};
    uint64_t key;
    if (!contenders_parse(&run.contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    bool ok = study_key(options, &key, error) && folder_reserve(options->folder, error) &&
              part_file_open(&run.part, options->folder, key, error) && run_scenes(&run, scenes, error) &&
              options->draw(options, scenes, key, error) && part_file_remove(&run.part, error);
    part_file_close(&run.part);
    contenders_free(&run.contenders);
    free(run.rows);
    return ok;
}
