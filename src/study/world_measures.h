/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures of a world's state. */
#pragma once
#include "dynamics/world.h"

/* J: kinetic and potential energy of a body; 0 if it is static. Heights are measured from y = 0. */
double body_energy(const Body *body, Vec2 gravity);

/* The sum over all bodies. */
double bodies_energy(const Body *bodies, int count, Vec2 gravity);
double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without one. */
double world_penetration(const World *world);
