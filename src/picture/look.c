/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/picture.h"
#include "trajectory/trajectory_states.h"

#include <stddef.h>

const char *const look_compare_names[] = {"split", "overlay", "difference", NULL};
const char *const look_camera_names[] = {"fit", "bomb", "divergence", NULL};
const char *const look_theme_names[] = {"light", "dark", NULL};
const char *const look_show_names[] = {"ghosts",   "distance",   "trails",   "contacts",
                                       "impulses", "velocities", "timeline", NULL};

/* The part of a look that compares bodies of several runs; NULL if none does. */
static const char *compares(const RenderLook *look) {
    if (look->compare != LOOK_SPLIT) return look_compare_names[look->compare];
    if (look->camera == LOOK_DIVERGENCE) return look_camera_names[LOOK_DIVERGENCE];
    if (look->show & LOOK_GHOSTS) return "ghosts";
    if (look->show & LOOK_DISTANCE) return "distance";
    return look->show & LOOK_TIMELINE ? "timeline" : NULL;
}

/* What was not recorded would look like what did not happen. */
static bool check_known(const RenderLook *look, const Trajectory *const *runs, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        if ((look->show & LOOK_VELOCITIES) != 0 && runs[i]->no_velocities)
            return error_input(error, "render", "'velocities' cannot be shown: run %d (%s) does not have them", i + 1,
                               runs[i]->method);
        if ((look->show & (LOOK_CONTACTS | LOOK_IMPULSES)) != 0 && runs[i]->no_contacts)
            return error_input(error, "render", "'%s' cannot be shown: run %d (%s) has no contacts",
                               look->show & LOOK_CONTACTS ? "contacts" : "impulses", i + 1, runs[i]->method);
    }
    return true;
}

bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error) {
    const char *what = compares(look);
    char difference[256];
    if (look->view.width != 0 && !camera_view_is_usable(&look->view))
        return error_input(error, "render", "the view %g x %g m at (%g, %g) cannot be drawn", look->view.width,
                           look->view.height, look->view.x, look->view.y);
    if (look->camera == LOOK_BOMB && runs[0]->bomb < 0)
        return error_input(error, "render", "the camera cannot follow the bomb: the first run has none");
    if (!check_known(look, runs, count, error)) return false;
    if (what == NULL) return true;
    if (count < 2) return error_input(error, "render", "'%s' compares runs, but there is only one", what);
    for (int i = 1; i < count; i++)
        if (trajectory_different_worlds(runs[0], runs[i], difference, sizeof difference))
            return error_input(error, "render", "'%s' compares run %d with the first, but their worlds differ (%s)",
                               what, i + 1, difference);
    return true;
}
