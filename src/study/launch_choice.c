/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/launch_choice.h"

#include "simulate/launch_check.h"

#include <stdlib.h>

static void sweep(const FloatRange *bomb_x, const Scene *scene, Launch *out) {
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
        sweep(&choice->bomb_x, scene, launches);
    else if (ok)
        ok = launches_for_scoring(scene, *count, launches, error);
    launches_free(&table);
    ok = ok && launches_check(scene, launches, *count, error);
    if (ok) return launches;
    free(launches);
    return NULL;
}
