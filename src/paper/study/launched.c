/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/launched.h"

#include "scene/launch.h"

#include <stdlib.h>

void launched_free(Launched *launched) {
    for (int i = 0; launched->states != NULL && i < launched->count; i++) snapshots_free(&launched->states[i]);
    free(launched->states);
    free(launched->launches);
    scene_destroy(launched->scene);
    *launched = (Launched){0};
}

bool launched_begin(Launched *launched, const char *path, int count, Error *error) {
    *launched = (Launched){.scene = scene_read(path, error), .count = count};
    if (launched->scene == NULL) return false;
    Launch *launches = malloc((size_t)count * sizeof *launches);
    launched->launches = malloc((size_t)count * sizeof *launched->launches);
    launched->states = calloc((size_t)count, sizeof *launched->states);
    bool ok = launches != NULL && launched->launches != NULL && launched->states != NULL;
    if (!ok) error_memory(error, path);
    if (ok && !launched->scene->bomb.present) ok = error_input(error, path, "the scene has no bomb");
    ok = ok && launches_for_scoring(launched->scene, count, launches, error);
    for (int i = 0; ok && i < count; i++) launched->launches[i] = launch_scene(launched->scene, &launches[i]);
    free(launches);
    if (!ok) launched_free(launched);
    return ok;
}
