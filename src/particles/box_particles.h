/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A box as particles: its corners, the middles of its edges and its centre; and the rigid box that fits nine particles
   best. Rigid fit of points: Müller, Heidelberger, Teschner, Gross, "Meshless Deformations Based on Shape Matching"
   (2005); in the plane the polar decomposition has a closed form. */
#pragma once
#include "dynamics/world.h"

enum { BOX_PARTICLES = 9 };

/* m, in the frame of the box: row by row from the lower left corner. */
Vec2 box_particle(int k, Vec2 size);

/* Where the particles [BOX_PARTICLES] of a box are. */
void box_particles_place(Vec2 *particles, Vec2 size, const BodyPose *pose);

/* The pose whose particles have the least mean square distance to these; `near` gives the whole turns of its angle. The
   same bits on every machine. */
BodyPose box_particles_fit(const Vec2 *particles, Vec2 size, const BodyPose *near);

/* m: the root of that mean square. */
float box_particles_distance(const Vec2 *particles, Vec2 size, const BodyPose *pose);

/* The angle of (cosine, sine), -pi to pi, without the maths library; the two need not have length 1. 0 for (0, 0). */
double plane_angle(double cosine, double sine);
