/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches that a study scores. */
#pragma once
#include "common/parse.h"
#include "scene/launch.h"

/* At most one of them; none: a number of the scene's family that the study chooses. */
typedef struct LaunchChoice {
    const char *table; /* path (scene/launch.h); NULL: none */
    FloatRange bomb_x; /* m; count 0: none */
    int count;         /* of the scene's family; 0: not given */
} LaunchChoice;

/* The launches of a scene with a bomb; *count is `standard` if the choice leaves it open. To be freed by the caller.
   NULL with error set for a table or a family that does not fit the scene, and for launches that launches_check()
   refuses. */
Launch *launch_choice_make(const LaunchChoice *choice, const Scene *scene, int standard, int *count, Error *error);
