/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_study.h"

#include <stdlib.h>

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

bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error) {
    *study = (SceneStudy){.scene = scene_read(path, error)};
    if (study->scene == NULL) return false;
    study->size = size_for(size, study->scene);
    bool ok = study->scene->bomb.present || error_input(error, path, "the scene has no bomb");
    ok = ok && choose_contenders(study, contenders, error);
    if (ok)
        study->launches = launch_choice_make(launches, study->scene, study->size.launches, &study->launch_count, error);
    if (study->launches != NULL) return true;
    scene_study_end(study);
    return false;
}

void scene_study_end(SceneStudy *study) {
    stepper_pool_end(&study->steppers);
    free(study->launches);
    free(study->contenders);
    scene_destroy(study->scene);
    *study = (SceneStudy){0};
}

Scene scene_study_launch(const SceneStudy *study, int launch) {
    return launch_scene(study->scene, &study->launches[launch]);
}
