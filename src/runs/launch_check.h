/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches of the bomb, and what else reading a scene does not check:

     if (!scene_check_launches(scene, &error) || !scene_check_networks(scene, &error)) ... */
#pragma once
#include "base/base.h"
#include "engine/boxes.h"
#include "scenes/scenes.h"

/* The launch of a single run and those of training and scoring: none puts the bomb inside a body. */
bool scene_check_launches(const Scene *scene, Error *error);

/* Reads each network that the scene names and runs one step with it, with the bomb and without. */
bool scene_check_networks(const Scene *scene, Error *error);

/* Reads the scene at `path` with each parameter at either end, the others as in the file, and checks the launches. The
   error ends with the parameter: "(with height = 20, an end of its range)". */
bool scene_check_ends(const char *path, const Scene *scene, Error *error);

/* Checks the launches of a scene with a bomb: none starts inside a body by more than SCENE_OVERLAP when it is added.
   Bodies are then where the engine has them: runs the scene once, without the bomb, up to the last launch's frame. A
   scene that allows overlaps needs no run. ERROR_INPUT names the launch, the body and the x that are free. */
bool launches_check(const Scene *scene, const Launch *launches, int count, Error *error);

/* True if the scene's bomb, added to this world now, would start inside none of its bodies. */
bool launch_is_free(const Scene *scene, const World *world);

/* The first step in which the bomb of this launch touches a box that can move, as the method has it; 0 if it does not,
   or if the method fails before (MethodFailure). */
bool launch_find_touch(const Scene *launched, const char *method, int *touch, Error *error);

/* Checks that the bomb strikes a box that can move, by the engine, in one launch at least of those for training: what
   learns from impacts needs one. A scene without a bomb passes. */
bool scene_check_strike(const Scene *scene, Error *error);

/* The ERROR_INPUT of launches that all miss. */
bool launches_refuse_misses(const Scene *scene, const Launch *launches, int count, Error *error);

/* Launches of the scene's family, spread evenly, that touch no box that can move, by the engine. */

enum { LAUNCH_TRIES = 41 };

typedef struct LaunchMisses {
    int tried, missed; /* fewer than LAUNCH_TRIES in large scenes, down to 0; without a family 1 */
    OverlapSpan spans[LAUNCH_TRIES / 2 + 1]; /* [span_count] of x, rising: launches tried in them miss, one and all */
    int span_count;
} LaunchMisses;

/* The scene must have a bomb. */
bool launches_find_misses(const Scene *scene, LaunchMisses *misses, Error *error);
