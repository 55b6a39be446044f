/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the method subspace and its training must see alike. */
#pragma once
#include "engine/engine.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <stdint.h>

/* Hash of what a network is trained for: bodies, bomb, gravity and time step, but not the launch nor how contacts are
   solved, because no contact is. */
uint64_t subspace_physics(const Scene *scene);

/* The launch as a predictor sees it. */
void subspace_launch(const Scene *launched, float launch[SUBSPACE_LAUNCH]);

/* The four numbers of a body's pose. */
void subspace_pose_numbers(Vec2 size, Vec2 position, float angle, float numbers[SUBSPACE_POSE]);
