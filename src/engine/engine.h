/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The engine: bodies, the contact problem of a step, and the world that takes steps. It knows no file and no method; of
   the bomb, only which body it is.

       World *world = world_create(&(WorldDef){.gravity = {0, -10}, .warm_starting = true}, error);
       world_add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .position = {0, 4}}, error);
       world_step(world, solve, state, 1 / 60.0f, error); // solve: a ContactSolve of the room `methods`
       world_bodies(world)[0].position;

   Boxes without a world: engine/boxes.h. */
#pragma once
#include "base/base.h"
#include "engine/boxes.h"
#include "engine/plane.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The definition of a body. Zero-initialise, then set at least size and mass. */
typedef struct BodyDef {
    Vec2 size;              /* full width and height, m, > 0 */
    bool fixed;             /* static: infinite mass */
    float mass;             /* kg, > 0; ignored where fixed */
    float friction;         /* coefficient, >= 0; a pair has sqrt(f1 f2) */
    Vec2 position;          /* m */
    float angle;            /* rad */
    Vec2 velocity;          /* m/s */
    float angular_velocity; /* rad/s */
} BodyDef;

typedef struct Body {
    Vec2 position;
    float angle;
    Vec2 velocity;
    float angular_velocity;
    Vec2 size;
    float friction;
    float inv_mass, inv_inertia; /* 0 if static */
} Body;

/* The contact problem of one step, frozen: the whole input of a contact solver. Datasets are recorded from it and
   accuracy is measured on it. Source: Catto, "Iterative Dynamics with Temporal Coherence" (2005) and "Fast and Simple
   Physics using Sequential Impulses" (GDC 2006). */

/* m: penetration that position correction leaves. */
#define CONTACT_SLOP 0.01f

typedef struct ProblemBody {
    Vec2 position;               /* m */
    float angle;                 /* rad */
    Vec2 size;                   /* full width and height, m */
    float inv_mass, inv_inertia; /* 1/kg, 1/(kg m^2); 0 for a static body */
    Vec2 velocity;               /* m/s, after gravity, before the warm start */
    float angular_velocity;      /* rad/s */
} ProblemBody;

/* True for a body of finite mass. */
static inline bool problem_body_moves(const ProblemBody *body) {
    return body->inv_mass != 0.0f || body->inv_inertia != 0.0f;
}

typedef struct ContactPoint {
    int a, b;                        /* bodies, a < b; the points of one pair are adjacent, pairs rise by (a, b) */
    Vec2 position;                   /* m, world */
    Vec2 normal;                     /* unit, from a to b; the tangent is normal turned a quarter clockwise */
    Vec2 arm_a, arm_b;               /* m, from the centre of each body to the point */
    float separation;                /* m, negative for penetration, positive only for kept and mended contacts */
    float mass_normal, mass_tangent; /* kg, effective masses along normal and tangent */
    float friction;                  /* coefficient of the pair */
    float bias;                      /* m/s, target normal velocity of position correction; 0 without it */
    uint32_t feature;                /* feature id: the edges that make the point */
    float warm_normal, warm_tangent; /* N s, impulses of the step before; 0 without warm starting or when new */
} ContactPoint;

typedef struct ContactProblem {
    int body_count, contact_count;
    int bomb;   /* index of the body; -1: none, or not known */
    float dt;   /* s */
    float fall; /* m/s, what gravity has added to each velocity: |g| dt; 0: nothing, or unknown */
    const ProblemBody *bodies;
    const ContactPoint *contacts;
} ContactProblem;

typedef struct BodyVelocity {
    Vec2 linear;   /* m/s */
    float angular; /* rad/s */
} BodyVelocity;

typedef struct ContactImpulse {
    float normal, tangent; /* N s, accumulated over the step; b gets +, a gets - */
} ContactImpulse;

/* What a method solved by simpler means than its own, and steps that did not converge: counts that results report. */
typedef struct Fallbacks {
    int not_finite;      /* outputs of a network that were NaN, infinite or out of bounds; discarded */
    int outside_cone;    /* impulses that were clamped to the friction cone */
    int beyond_training; /* steps unlike what the method was trained on (the method's file says what it does then) */
    int by_sweeps;       /* steps in which sweeps solved an island instead */
    int not_converged;   /* steps that stayed above the tolerance of the method: no yardstick for others */
    double residual;     /* m/s: the largest of those */
} Fallbacks;

static inline void fallbacks_add(Fallbacks *sum, const Fallbacks *step) {
    sum->not_finite += step->not_finite;
    sum->outside_cone += step->outside_cone;
    sum->beyond_training += step->beyond_training;
    sum->by_sweeps += step->by_sweeps;
    sum->not_converged += step->not_converged;
    if (step->not_converged > 0 && !(step->residual <= sum->residual)) sum->residual = step->residual;
}

/* What a solver fills in; the arrays are the caller's. */
typedef struct ContactSolution {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count]; zeros from a method without impulses */
    /* N s: momentum that no impulse accounts for, summed over pairs or bodies as the method's file says; 0 for a method
       that applies impulses */
    float momentum_error;
    Fallbacks fallbacks; /* zeros for most methods */
} ContactSolution;

/* Velocities before any impulse, and no impulses. */
void contact_solution_begin(const ContactProblem *problem, ContactSolution *solution);

/* Solves a contact problem: fills the solution. False with error set only when memory is short or the problem cannot be
   solved at all. Allocates nothing once the state has met a problem of that size. */
typedef bool ContactSolve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);

/* How contacts are found. Zeros: as Box2D-Lite finds them, with its bits.

   keep > 0: a pair of two points in the last step is kept instead of being found again, while its boxes have shifted
   along its face, or apart, by less than `keep` of the smaller side since its points were found, and neither has turned
   by more than 0.2 rad. Its separations follow the boxes and may be positive; lever arms and normal stay as they were
   in world coordinates. So a column that leans a little has no tipping moment from contacts that give way under its own
   weight, which it would otherwise buckle by. The price: support up to `keep` beyond an edge. Sweeps that end early
   still let boxes sink. Source: Catto, Box2D's contact recycling (2026), whose tolerance is a length.

   mend: boxes touch from a gap of 1% of the smaller side on, which a step may close and no more, and keep the sides
   with which they touch, the overlap with which they met, and impulses by place; there are no ghosts at seams
   (contact_problem.c). As Box2D-Lite finds contacts, boxes that rounding or the end of sweeps sets apart fall until
   they overlap, each layer of a stack a step after the one below; thin ones are pressed past one another, and then
   pushed out on the wrong side. Box2D v3, too, has contacts before boxes overlap: from four slops on. */
typedef struct ContactRules {
    float keep;
    bool mend;
} ContactRules;

/* The mutable state of a simulation: bodies, the contacts that persist between them, and the step.

   Collision detection, then gravity, then the contact problem with its warm start, then a contact solver, then
   integration (semi-implicit Euler): the loop of Box2D-Lite (Catto 2006), with the same bits
   (tests/runs/test_reference.c). */

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

/* From the next step on; zeros at first. */
void world_set_contacts(World *world, ContactRules rules);

/* Says which body is the bomb (-1: none), for those who read the contact problem. The step treats it as any other. */
void world_set_bomb(World *world, int body);

/* Copies the state of `from` to `to`. False with error set when memory is short. */
bool world_copy(World *to, const World *from, Error *error);

/* A step in parts, for steppers that need more than one solver call. The world does not change before the step ends, so
   a step need not be ended.

   Begins a step of dt seconds (dt > 0): collision detection, gravity, the contact problem. The world owns the problem's
   arrays and the solution, which the caller fills; they are valid until the next step. False with error set when memory
   is short, or for more than BROAD_PHASE_MAX_PAIRS. */
bool world_begin_step(World *world, float dt, ContactProblem *problem, ContactSolution **solution, Error *error);

/* After a step has begun, and until it ends: [contact_count] for each contact the index of the same point in the step
   before, or -1: one with the same feature id, or at the same place (ContactRules.mend). */
const int *world_contacts_before(const World *world);

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

/* Advances the world by dt seconds with a solver and its state. On failure the world is unchanged; error names the
   first body whose state is NaN or infinite, or is the solver's. */
bool world_step(World *world, ContactSolve *solve, void *state, float dt, Error *error);

int world_body_count(const World *world);
const Body *world_bodies(const World *world);

/* The contact problem of the last step and its solution; valid until the next step, even if bodies are added or removed
   meanwhile. Empty before the first step. */
const ContactProblem *world_problem(const World *world);
const ContactSolution *world_solution(const World *world);

/* Energy and penetration of a world. */

/* J: kinetic and potential energy, with potential 0 at the origin; 0 for static bodies. */
double body_energy(const Body *body, Vec2 gravity);

double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without contacts. */
double world_penetration(const World *world);
