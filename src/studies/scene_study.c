/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene of the study: its launches and contenders. */
#include "base/base.h"
#include "base/machine.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/scene_study.h"
#include "studies/stepper_pool.h"

#include <stdlib.h>

static void scene_study_sweep(const FloatRange *bomb_x, const Scene *scene, Launch *out) {
    for (int i = 0; i < bomb_x->count; i++) {
        out[i] = launch_of(scene);
        out[i].x = range_value(bomb_x, i);
    }
}

Launch *launch_choice_make(const LaunchChoice *choice, const Scene *scene, int standard, int *count, Error *error) {
    LaunchTable table = {0};
    if (choice->table != NULL && !launches_read(&table, choice->table, error)) return NULL;
    *count = choice->table != NULL      ? table.count
             : choice->bomb_x.count > 0 ? choice->bomb_x.count
             : choice->count > 0        ? choice->count
                                        : standard;
    Launch *launches = malloc((size_t)*count * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "launches");
    if (ok && choice->table != NULL)
        ok = launches_for(&table, scene, launches, error);
    else if (ok && choice->bomb_x.count > 0)
        scene_study_sweep(&choice->bomb_x, scene, launches);
    else if (ok)
        ok = launches_for_scoring(scene, *count, launches, error);
    launches_free(&table);
    ok = ok && launches_check(scene, launches, *count, error);
    if (ok) return launches;
    free(launches);
    return NULL;
}

static bool scores_without_push_out(const SceneStudy *study) {
    for (int i = 0; i < study->contender_count; i++)
        if (study->contenders[i]->method.kind->description->no_push_out) return true;
    return false;
}

/* A step takes time in proportion to its bodies, its converged solution even more. So larger scenes have fewer launches
   and fewer scored steps after the impact. */
static StudySize size_for(const StudySize *full, const Scene *scene) {
    enum { SMALL = 110, LEAST_LAUNCHES = 4, LEAST_TIMED = 2 }; /* SMALL: bodies */
    StudySize size = *full;
    if (scene->body_count <= SMALL) return size;
    const int launches = size.launches * SMALL / scene->body_count,
              timed = size.timed_launches * SMALL / scene->body_count;
    size.closed.after *= 2;
    size.closed.rest *= 4;
    size.launches = launches > LEAST_LAUNCHES ? launches : LEAST_LAUNCHES;
    size.timed_launches = timed > LEAST_TIMED ? timed : LEAST_TIMED;
    return size;
}

static bool choose_contenders(SceneStudy *study, const ContenderList *contenders, Error *error) {
    study->contenders = malloc((size_t)(contenders->count + 1) * sizeof *study->contenders);
    if (study->contenders == NULL) return error_memory(error, "study");
    study->contender_count = contenders_for(contenders, study->scene, study->contenders);
    study->no_push_out = scores_without_push_out(study);
    return stepper_pool_begin(&study->steppers, study->contender_count, error);
}

static bool try_launch(void *context, int i, Error *error) {
    SceneStudy *study = context;
    const Scene launched = scene_study_launch(study, i);
    return launch_find_touch(&launched, "engine", &study->striking[i], error);
}

/* Finds the launches that strike a box: only these have times of an impact. */
static bool find_striking(SceneStudy *study, Error *error) {
    const ParallelWork tries = {try_launch, study};
    study->striking = calloc((size_t)study->launch_count, sizeof *study->striking);
    if (study->striking == NULL) return error_memory(error, "study");
    if (!parallel_for(&tries, study->launch_count, study->scene->name, NULL, error)) return false;
    for (int i = 0; i < study->launch_count; i++)
        if (study->striking[i] > 0) study->striking[study->striking_count++] = i;
    return study->striking_count > 0 ||
           launches_refuse_misses(study->scene, study->launches, study->launch_count, error);
}

bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error) {
    *study = (SceneStudy){.scene = scene_read(path, error)};
    if (study->scene == NULL) return false;
    study->size = size_for(size, study->scene);
    bool ok = study->scene->bomb.present || error_input(error, path, "the scene has no bomb");
    ok = ok && choose_contenders(study, contenders, error);
    if (ok)
        study->launches = launch_choice_make(launches, study->scene, study->size.launches, &study->launch_count, error);
    if (study->launches != NULL && find_striking(study, error)) return true;
    scene_study_end(study);
    return false;
}

void scene_study_end(SceneStudy *study) {
    stepper_pool_end(&study->steppers);
    free(study->launches);
    free(study->striking);
    free(study->contenders);
    scene_destroy(study->scene);
    *study = (SceneStudy){0};
}

Scene scene_study_launch(const SceneStudy *study, int launch) {
    return launch_scene(study->scene, &study->launches[launch]);
}

int scene_study_timed(const SceneStudy *study) {
    const int most = study->size.timed_launches;
    return most < study->striking_count ? most : study->striking_count;
}
