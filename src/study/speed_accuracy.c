/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/speed_accuracy.h"

#include "common/folder_reserve.h"

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
    ContenderList contenders;
    ChartPlan plan;
    SpeedAccuracyScene *scenes; /* [scenes of the plan] */
    ChartRow *rows;             /* of all scenes */
    int row_count;
    char (*cpus)[CPU_NAME_SIZE]; /* [scenes of the plan] */
} Run;

/* A missing network is an error only of the method that needs it. */
static bool add_scene_to_key(StudyKey *key, const char *path, Error *error) {
    Scene *scene = scene_read(path, error);
    if (scene == NULL) return false;
    for (int i = 0; i < scene->network_count; i++) study_key_add_file(key, scene->networks[i].path, &(Error){0});
    scene_destroy(scene);
    return study_key_add_file(key, path, error);
}

/* Hashes everything that determines the result: the program, the options and the files. */
static bool find_key(const SpeedAccuracyOptions *options, StudyKey *key, Error *error) {
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

static SpeedAccuracyScene summarise(const Run *run, const SceneStudy *study) {
    SpeedAccuracyScene summary = {.contenders = study->contender_count,
                                  .launches = study->launch_count,
                                  .without_network = contenders_without_network(&run->contenders, study->scene)};
    snprintf(summary.name, sizeof summary.name, "%s", study->scene->name);
    return summary;
}

static bool assemble(Run *run, const Pieces *pieces, Error *error) {
    size_t count = 0;
    for (int i = 0; i < run->plan.count; i++) count += (size_t)run->plan.scenes[i].study.contender_count * ROWS_EACH;
    run->rows = malloc((count + 1) * sizeof *run->rows);
    run->cpus = calloc((size_t)run->plan.count + 1, sizeof *run->cpus);
    if (run->rows == NULL || run->cpus == NULL) return error_memory(error, "study");
    for (int i = 0; i < run->plan.count; i++) {
        const ChartScene *scene = &run->plan.scenes[i];
        SpeedAccuracyScene *summary = &run->scenes[i];
        *summary = summarise(run, &scene->study);
        if (!chart_assemble(pieces, scene, run->rows + run->row_count, run->cpus[i], &summary->solves, error))
            return false;
        summary->timed = pieces_keep_times(pieces, run->cpus[i]);
        run->row_count += summary->contenders * ROWS_EACH;
    }
    return true;
}

/* What follows from the pieces, once all are there. */
static bool finish(Run *run, const Pieces *pieces, Error *error) {
    const SpeedAccuracyOptions *options = run->options;
    char path[CSV_PATH_SIZE];
    return csv_table_path(path, options->folder, &chart_layout, error) && assemble(run, pieces, error) &&
           folder_reserve(options->folder, error) &&
           csv_table_write(path, &chart_layout, run->rows, run->row_count, error) &&
           options->draw(options, run->scenes, pieces->key, error) && pieces_end(pieces, error);
}

/* Shards share a folder; a whole study has it to itself. */
static bool do_pieces(Run *run, Pieces *pieces, const StudyKey *key, const Progress *progress, Error *error) {
    const SpeedAccuracyOptions *options = run->options;
    if (!pieces_open(pieces, options->folder, false, key, options->run, error)) return false;
    if (pieces->mode == PIECES_WHOLE && !folder_reserve(options->folder, error)) return false;
    return pieces_do(pieces, &run->plan.plan, progress, error) &&
           (pieces->mode == PIECES_SHARD || finish(run, pieces, error));
}

bool speed_accuracy_run(const SpeedAccuracyOptions *options, Pieces *pieces, const Progress *progress,
                        SpeedAccuracyScene *scenes, Error *error) {
    Run run = {.options = options, .scenes = scenes};
    StudyKey key = {0};
    if (!contenders_parse(&run.contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    const bool ok = chart_plan_make(&run.plan, options->scenes, options->scene_count, &run.contenders,
                                    &options->launches, speed_accuracy_size(options->quick), error) &&
                    find_key(options, &key, error) && do_pieces(&run, pieces, &key, progress, error);
    pieces->plan = NULL;
    chart_plan_free(&run.plan);
    study_key_free(&key);
    contenders_free(&run.contenders);
    free(run.rows);
    free(run.cpus);
    return ok;
}
