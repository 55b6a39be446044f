/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/panels.h"

#include "cli/notes.h"
#include "cli/progress_bar.h"
#include "cli/simulate_verdict.h"
#include "common/standard_io.h"
#include "common/file.h"
#include "scene/launch.h"
#include "simulate/simulate.h"
#include "trajectory/trajectory_name.h"
#include "type/type_check.h"

#include <stdio.h>
#include <string.h>

static bool add(Panels *panels, Trajectory *run, const char *input, Error *error) {
    if (run == NULL) return false;
    if (!type_check(run->scene, input, error) || !type_check(run->method, input, error)) {
        trajectory_destroy(run);
        return false;
    }
    if (panels->count == RENDER_PANELS_MAX) {
        trajectory_destroy(run);
        return error_input(error, input, "more than %d panels", RENDER_PANELS_MAX);
    }
    panels->inputs[panels->count] = input;
    panels->runs[panels->count++] = run;
    return true;
}

bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error) {
    return panels_add_watched(panels, scene, method_name, input, NULL, error);
}

bool panels_add_watched(Panels *panels, const Scene *scene, const char *method_name, const char *input,
                        const Progress *progress, Error *error) {
    Method method;
    if (!method_parse(&method, method_name, error)) return false;
    if (progress != NULL) return add(panels, simulate_judged(scene, &method, progress, error), input, error);
    char what[2 * SCENE_NAME_SIZE + 8];
    snprintf(what, sizeof what, "%s by %s", scene->name, method_name);
    Trajectory *run = simulate_judged(scene, &method, progress_bar_begin(what), error);
    progress_bar_end();
    return add(panels, run, input, error);
}

/* Why a scene has one panel, and the commands that give it a second one. */
static void note_engine_only(const char *input, const Scene *scene) {
    char method[2 * SCENE_NAME_SIZE] = "scene-net:network=net.npz", train[1024] = "";
    const char *lacks = "no network";
    if (scene->network_count > 0) {
        lacks = "no pair-net";
        snprintf(method, sizeof method, "%s", scene->networks[0].method);
    } else if (scene->bomb.present && scene_span_varies(&scene->bomb.x)) {
        snprintf(train, sizeof train, "    twinbox train --kind scene-net %s -o net.npz\n", input);
    } else {
        note_print(
            "%s names no network, so only the engine is drawn; to train one for it, give it a bomb with a family of "
            "launches, x: {from: A, to: B}",
            input);
        return;
    }
    note_print("%s names %s, so only the engine is drawn. To %sdraw a network beside it:\n%s"
               "    twinbox simulate %s -o engine.npz\n"
               "    twinbox simulate %s --method %s -o network.npz\n"
               "    twinbox render engine.npz network.npz -o DIR",
               input, lacks, train[0] != '\0' ? "train and " : "", train, input, input, method);
}

static bool add_scene(Panels *panels, const char *input, const SceneSettings *set, Error *error) {
    Scene *scene = scene_read_with(input, set->items, set->count, error);
    bool ok =
        scene != NULL && type_check(scene->name, input, error) && panels_add_run(panels, scene, "engine", input, error);
    if (ok && scene_network(scene, "pair-net") != NULL)
        ok = panels_add_run(panels, scene, "pair-net", input, error);
    else if (ok)
        note_engine_only(input, scene);
    scene_destroy(scene);
    return ok;
}

static bool is_stored(const char *input) {
    const char *ending = strrchr(input, '.');
    if (path_is_standard(input)) return standard_input_is_zip();
    return ending != NULL && strcmp(ending, ".npz") == 0;
}

bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set, Error *error) {
    int scenes = 0;
    for (int i = 0; i < input_count; i++) scenes += !is_stored(inputs[i]);
    if (set->count > 0 && scenes != 1) return error_input(error, "--set", "needs exactly one scene (got %d)", scenes);
    for (int i = 0; i < input_count; i++) {
        bool ok = is_stored(inputs[i]) ? add(panels, trajectory_read(inputs[i], error), inputs[i], error)
                                       : add_scene(panels, inputs[i], set, error);
        if (!ok) return false;
    }
    return true;
}

void panels_free(Panels *panels) {
    for (int i = 0; i < panels->count; i++) trajectory_destroy(panels->runs[i]);
    panels->count = 0;
}

bool panels_store(const Panels *panels, const char *directory, Error *error) {
    for (int i = 0; i < panels->count; i++) {
        char name[TRAJECTORY_FILE_NAME_SIZE], path[4096];
        trajectory_file_name((const Trajectory *const *)panels->runs, i, name);
        if (!file_path(path, sizeof path, error, "%s/%s", directory, name) ||
            !trajectory_write(panels->runs[i], path, error))
            return false;
    }
    return true;
}
