/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a world's state amounts to. */
#pragma once
#include "dynamics/world.h"

/* J: kinetic and potential, of all that moves; heights count from y = 0. */
double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without one. */
double world_penetration(const World *world);
