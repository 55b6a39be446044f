/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mutable state of a simulation: bodies, the contacts that persist between them, and the step.

   Collision detection, then gravity, then the contact problem with its warm start, then a contact solver, then
   integration (semi-implicit Euler): the loop of Box2D-Lite (Catto 2006), with the same bits (tests/reference). */
#pragma once
#include "common/error.h"
#include "dynamics/body.h"
#include "dynamics/contact_problem.h"

#include <stddef.h>

typedef struct WorldDef {
    Vec2 gravity;             /* m/s^2 */
    bool warm_starting;       /* hand the last step's impulses to the solver */
    bool position_correction; /* push overlapping boxes apart (Baumgarte) */
} WorldDef;

typedef struct World World;

World *world_create(const WorldDef *def, Error *error);
void world_destroy(World *world);

/* Adds a body; its index is the number of bodies before it. Pairs are sorted by index, so the order of bodies
   matters. */
bool world_add_body(World *world, const BodyDef *def, Error *error);

/* Removes the body added last, and its contacts; the other contacts keep their impulses. The world must have a body. */
void world_remove_last_body(World *world);

/* Marks a body (-1: none) for those who read the contact problem: a scene marks its bomb. The step makes no difference. */
void world_mark(World *world, int body);

/* Copies the state of `from` to `to`. False with error set when memory is short. */
bool world_copy(World *to, const World *from, Error *error);

/* A step in parts, for steppers that need more than one solver call. The world does not change before the step ends, so
   a step need not be ended.

   Begins a step of dt seconds (dt > 0): collision detection, gravity, the contact problem. The world owns the problem's
   arrays and the solution, which the caller fills; they are valid until the next step. False with error set when memory is
   short, or for more than BROAD_PHASE_MAX_PAIRS. */
bool world_begin_step(World *world, float dt, ContactProblem *problem, ContactSolution **solution, Error *error);

/* Ends the step: moves the bodies by the velocities of the solution. On failure the world is unchanged and error names
   the first body whose state is NaN or infinite. */
bool world_end_step(World *world, Error *error);

/* Position and angle of a body. */
typedef struct BodyPose {
    Vec2 position; /* m */
    float angle;   /* rad */
} BodyPose;

/* The same, with the final poses [body_count] given, for steppers that integrate in substeps. */
bool world_end_step_at(World *world, const BodyPose *poses, Error *error);

/* Advances the world by dt seconds with a solver and its state. On failure the world is unchanged; error names the first
   body whose state is NaN or infinite, or is the solver's. */
bool world_step(World *world, ContactSolve *solve, void *state, float dt, Error *error);

int world_body_count(const World *world);
const Body *world_bodies(const World *world);

/* The contact problem of the last step and its solution; valid until the next step, even if bodies are added or removed
   meanwhile. Empty before the first step. */
const ContactProblem *world_problem(const World *world);
const ContactSolution *world_solution(const World *world);
