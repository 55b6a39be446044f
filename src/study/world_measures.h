/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a world's state amounts to. */
#pragma once
#include "dynamics/world.h"

/* J: kinetic and potential; 0 for what is static. Heights count from y = 0; without gravity it is the kinetic alone. */
double body_energy(const Body *body, Vec2 gravity);

/* The sum. */
double bodies_energy(const Body *bodies, int count, Vec2 gravity);
double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without one. */
double world_penetration(const World *world);
