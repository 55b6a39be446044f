/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refuses bombs that would start inside a body. */
#pragma once
#include "scene/launch.h"

/* Checks the launches of a scene with a bomb: none starts inside a body by more than SCENE_OVERLAP when it is added.
   Bodies are then where the engine has them: runs the scene once, without the bomb, up to the last launch's frame. A
   scene that allows overlaps needs no run. ERROR_INPUT names the launch, the body and the x that are free. */
bool launches_check(const Scene *scene, const Launch *launches, int count, Error *error);

/* True if the scene's bomb, added to this world now, would start inside none of its bodies. */
bool launch_is_free(const Scene *scene, const World *world);
