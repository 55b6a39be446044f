/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs in a picture. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/judge.h"
#include "cli/notes.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pixels/type.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

RenderOptions render_defaults(const char *directory) {
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return (RenderOptions){.width = 1920,
                           .height = 1080,
                           .first = 0,
                           .last = -1,
                           .jobs = (int)fmin(fmax((double)cores, 1), RENDER_JOBS_MAX),
                           .directory = directory,
                           .describe = method_describe};
}

static bool panels_add(Panels *panels, Trajectory *run, const char *input, Error *error) {
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
    Method method;
    if (!method_parse(&method, method_name, error)) return false;
    char what[2 * SCENE_NAME_SIZE + 8];
    snprintf(what, sizeof what, "%s by %s", scene->name, method_name);
    Trajectory *run = simulate_judged(scene, &method, progress_bar_begin(what), error);
    progress_bar_end();
    return panels_add(panels, run, input, error);
}

/* Why a scene has one panel, and the commands that give it a second one. */
static void note_engine_only(const char *input, const Scene *scene) {
    const bool trained = scene->network_count > 0;
    char train[1024] = "";
    if (!trained && !(scene->bomb.present && scene_span_varies(&scene->bomb.x))) {
        note_print(
            "%s names no network, so only the engine is drawn; to train one for it, give it a bomb with a family of "
            "launches, x: {from: A, to: B}",
            input);
        return;
    }
    if (!trained) snprintf(train, sizeof train, "    twinbox train --kind scene-net %s -o net.npz\n", input);
    note_print("%s names no %s, so only the engine is drawn. To %sdraw a network beside it:\n%s"
               "    twinbox render %s --method engine --method %s -o DIR",
               input, trained ? "pair-net" : "network", trained ? "" : "train and ", train, input,
               trained ? scene->networks[0].method : "scene-net:network=net.npz");
}

bool panels_add_scene(Panels *panels, const char *input, const SceneSettings *set, const PanelMethods *methods,
                      Error *error) {
    static const PanelMethods both = {{"engine", "pair-net"}, 2}, engine = {{"engine"}, 1};
    Scene *scene = scene_read_with(input, set->items, set->count, error);
    bool ok = scene != NULL && type_check(scene->name, input, error);
    const bool chosen = methods->count > 0, network = ok && scene_network(scene, "pair-net") != NULL;
    if (!chosen) methods = network ? &both : &engine;
    for (int i = 0; ok && i < methods->count; i++) ok = panels_add_run(panels, scene, methods->texts[i], input, error);
    if (ok && !chosen && !network) note_engine_only(input, scene);
    scene_destroy(scene);
    return ok;
}

static bool is_stored(const char *input) {
    const char *ending = strrchr(input, '.');
    if (path_is_standard(input)) return standard_input_is_zip();
    return ending != NULL && strcmp(ending, ".npz") == 0;
}

bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set,
                 const PanelMethods *methods, Error *error) {
    int scenes = 0;
    for (int i = 0; i < input_count; i++) scenes += !is_stored(inputs[i]);
    if (set->count > 0 && scenes != 1) return error_input(error, "--set", "needs exactly one scene (got %d)", scenes);
    if (methods->count > 0 && scenes == 0)
        return error_input(error, "--method", "needs a scene; a run (.npz) is shown as it was simulated");
    for (int i = 0; i < input_count; i++) {
        bool ok = is_stored(inputs[i]) ? panels_add(panels, trajectory_read(inputs[i], error), inputs[i], error)
                                       : panels_add_scene(panels, inputs[i], set, methods, error);
        if (!ok) return false;
    }
    return true;
}

void panels_free(Panels *panels) {
    for (int i = 0; i < panels->count; i++) trajectory_destroy(panels->runs[i]);
    panels->count = 0;
}

void note_different_scenes(const Trajectory *const *runs, int count) {
    for (int i = 1; i < count; i++) {
        const Trajectory *a = runs[0], *b = runs[i];
        const bool named = strcmp(a->scene, b->scene) == 0;
        if (a->scene_hash == 0 || b->scene_hash == 0 || (named && a->scene_hash == b->scene_hash)) continue;
        if (!named)
            note_print("the runs are of different scenes: %s (by %s) and %s (by %s)", a->scene, a->method, b->scene,
                       b->method);
        else
            note_print(
                "the runs of %s by %s and by %s are of different scenes: their launches, settings or files differ "
                "(scene_hash %016" PRIx64 " and %016" PRIx64 ")",
                a->scene, a->method, b->method, a->scene_hash, b->scene_hash);
        return;
    }
}
