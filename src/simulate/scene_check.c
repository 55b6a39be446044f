/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/scene_check.h"

#include "common/text_add.h"
#include "simulate/launch_check.h"
#include "simulate/simulate.h"

#include <string.h>

bool scene_check_launches(const Scene *scene, Error *error) {
    enum { TRAINING = LAUNCH_GRID, SCORING = LAUNCH_GRID - 1 };
    Launch launches[TRAINING + SCORING + 1];
    int count = 0;
    if (!scene->bomb.present) return true;
    if (launch_has_family(scene)) {
        if (!launches_for_training(scene, TRAINING, launches, error) ||
            !launches_for_scoring(scene, SCORING, launches + TRAINING, error))
            return false;
        count = TRAINING + SCORING;
    }
    launches[count++] = launch_of(scene);
    return launches_check(scene, launches, count, error);
}

static bool ignore(void *context, int frame, const World *world, Error *error) {
    (void)context, (void)frame, (void)world, (void)error;
    return true;
}

static bool run_one_step(const Scene *scene, const Method *method, bool with_bomb, Error *error) {
    Scene short_run = *scene;
    short_run.frames = 1;
    short_run.bomb.frame = 0;
    short_run.bomb.present = scene->bomb.present && with_bomb;
    short_run.overlaps_allowed = true; /* it may not be the bomb's frame */
    return simulate_observed(&short_run, method, &(StepObserver){ignore, NULL}, error);
}

bool scene_check_networks(const Scene *scene, Error *error) {
    for (int i = 0; i < scene->network_count; i++) {
        Method method;
        const SceneNetwork *network = &scene->networks[i];
        if (!method_parse(&method, network->method, error)) return false;
        if (!method.kind->description->needs_network)
            return error_input(error, network->path, "the method %s has no network", network->method);
        if (!run_one_step(scene, &method, false, error) ||
            (scene->bomb.present && !run_one_step(scene, &method, true, error)))
            return false;
    }
    return true;
}

static bool check_end(const char *path, const SceneSetting *setting, Error *error) {
    Scene *scene = scene_read_with(path, setting, 1, error);
    const bool ok = scene != NULL && scene_check_launches(scene, error);
    scene_destroy(scene);
    if (!ok) error_add(error, "\n(with %s = %.9g, an end of its range)", setting->name, setting->value);
    return ok;
}

bool scene_check_ends(const char *path, const Scene *scene, Error *error) {
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        SceneSetting setting = {.value = parameter->from};
        strcpy(setting.name, parameter->name);
        if (!check_end(path, &setting, error)) return false;
        setting.value = parameter->to;
        if (!check_end(path, &setting, error)) return false;
    }
    return true;
}
