/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/look.h"

#include <stddef.h>

const char *const look_compare_names[] = {"split", "overlay", "difference", NULL};
const char *const look_camera_names[] = {"fit", "bomb", "divergence", NULL};
const char *const look_theme_names[] = {"light", "dark", NULL};
const char *const look_show_names[] = {"ghosts",   "distance",   "trails",   "contacts",
                                       "impulses", "velocities", "timeline", NULL};
