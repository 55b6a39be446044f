/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The changing half of a simulation: bodies, the contacts that persist between them, and the step.

   Collision detection, then gravity, then the contact problem with its warm start, then a contact solver, then
   integration (semi-implicit Euler): the loop of Box2D-Lite (Catto 2006), same bits (tests/reference). */
#pragma once
#include "common/error.h"
#include "dynamics/body.h"
#include "dynamics/contact_solver.h"

#include <stddef.h>

typedef struct WorldDef {
    Vec2 gravity;             /* m/s^2 */
    bool warm_starting;       /* hand the last step's impulses to the solver */
    bool position_correction; /* push overlapping boxes apart (Baumgarte) */
} WorldDef;

typedef struct World World;

World *world_create(const WorldDef *def, Error *error);
void world_destroy(World *world);

/* Adds a body; its index is the number of bodies before it. Indices order the pairs, so the order matters. */
bool world_add_body(World *world, const BodyDef *def, Error *error);

/* Takes out the body added last. Its contacts are forgotten; those between the others keep their impulses. There is
   one. */
void world_remove_last_body(World *world);

/* Tells the contact problem which body is the bomb (-1: none). */
void world_set_bomb(World *world, int body);

/* Makes `to` what `from` is now, whatever it was. False with error set when memory is short. */
bool world_copy(World *to, const World *from, Error *error);

/* A step, in parts, for who solves contacts in another way than by one call of a solver. Until the step ends, the
   world is as it was before: a step begun may be forgotten.

   Begins one of dt seconds (dt > 0): collision detection, gravity, the contact problem. Its arrays and the solution,
   which is to be filled in, are the world's and last until the next step. */
bool world_begin_step(World *world, float dt, ContactProblem *problem, ContactSolution **solution, Error *error);

/* Ends it by the solution filled in: the new velocities carry the bodies. On failure world is unchanged and error
   says which body left the finite numbers. */
bool world_end_step(World *world, Error *error);

/* Where a body is. */
typedef struct BodyPose {
    Vec2 position; /* m */
    float angle;   /* rad */
} BodyPose;

/* The same, with the poses [body_count] that the bodies came to on the way. */
bool world_end_step_at(World *world, const BodyPose *poses, Error *error);

/* Advances world by dt seconds: begins, solves, ends. On failure world is unchanged and error says why. */
bool world_step(World *world, const ContactSolver *solver, float dt, Error *error);

int world_body_count(const World *world);
const Body *world_bodies(const World *world);

/* The contact problem of the last step and its solution; valid until the next, also where bodies have been added or
   taken out meanwhile. Empty before the first. */
const ContactProblem *world_problem(const World *world);
const ContactSolution *world_solution(const World *world);
