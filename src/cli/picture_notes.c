/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/picture_notes.h"

#include "cli/notes.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static bool differ(const Trajectory *a, const Trajectory *b) {
    return a->scene_hash != 0 && b->scene_hash != 0 &&
           (a->scene_hash != b->scene_hash || strcmp(a->scene, b->scene) != 0);
}

void note_different_scenes(const Trajectory *const *runs, int count) {
    for (int i = 1; i < count; i++) {
        const Trajectory *a = runs[0], *b = runs[i];
        if (!differ(a, b)) continue;
        if (strcmp(a->scene, b->scene) != 0)
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

void note_missing_impact(const MomentPlan *plan, int impact) {
    char slow[64] = "nothing is slowed down";
    if (impact >= plan->first && impact <= plan->last) return;
    if (plan->slow > 1)
        snprintf(slow, sizeof slow, "frames %d to %d beside it are slowed down", plan->slow_first, plan->slow_last);
    if (impact < 0)
        note_print("--slow: no run has a contact of the bomb with a box; %s", slow);
    else
        note_print("--slow: frames %d to %d do not contain the impact, frame %d; %s", plan->first, plan->last, impact,
                   slow);
}
