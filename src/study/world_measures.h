/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy and penetration of a world. */
#pragma once
#include "dynamics/world.h"

/* J: kinetic and potential energy, with potential 0 at the origin; 0 for static bodies. */
double body_energy(const Body *body, Vec2 gravity);

double bodies_energy(const Body *bodies, int count, Vec2 gravity);
double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without contacts. */
double world_penetration(const World *world);
