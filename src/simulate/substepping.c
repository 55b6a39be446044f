/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Substepping: one collision pass, then n small steps of dt / n, each with its share of gravity, k sweeps of sequential
   impulses and integration (Macklin et al., "Small Steps in Physics Simulation", 2019; temporal Gauss-Seidel).

   Normals, lever arms and effective masses stay those of the collision pass; a separation changes by the velocity along
   its normal. Impulses add up over the whole step and are clamped as a sum, so that what stops a fall in one small step
   is not applied again in the next; the warm start comes in n equal shares, as gravity does. The velocity that pushes an
   overlap apart is that of the whole step: then the step ends with the velocities of a converged solve of the whole.

   Fails like n k sweeps of one whole step, which at rest it beats, as every small step sees what the last one left; where
   a single impact has to travel through a stack it is no better, and dearer. */
#include "common/array.h"
#include "dynamics/contacts.h"
#include "simulate/stepping.h"
#include "solvers/sweeps.h"

#include <stdlib.h>

typedef struct Substepping {
    int substeps, sweeps_each;
    Sweeps sweeps;
    BodyPose *poses;       /* [bodies] */
    ContactImpulse *share; /* [contacts] of the warm start, for each small step */
    float *separations;    /* [contacts] now */
    size_t pose_capacity, share_capacity, separation_capacity;
} Substepping;

static const SettingSpec settings[] = {
    {"substeps", "small steps a step (4)"}, {"k", "sweeps a small step (1)"}, {NULL, NULL}};

static void destroy(void *state) {
    Substepping *stepping = state;
    sweeps_free(&stepping->sweeps);
    free(stepping->poses);
    free(stepping->share);
    free(stepping->separations);
    free(stepping);
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    (void)scene;
    Substepping *stepping = calloc(1, sizeof *stepping);
    if (stepping == NULL) {
        error_memory(error, "substepping");
        return NULL;
    }
    stepping->substeps = 4;
    stepping->sweeps_each = 1;
    if (settings_int(chosen, "substeps", 1, 1000, &stepping->substeps, error) &&
        settings_int(chosen, "k", 1, SWEEPS_MAX, &stepping->sweeps_each, error))
        return stepping;
    destroy(stepping);
    return NULL;
}

/* The bodies before gravity, the contacts as the collision pass found them. */
static bool begin(Substepping *stepping, const World *world, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!sweeps_begin(&stepping->sweeps, sweeps_best_kernel(), problem, false, 1) ||
        !array_reserve((void **)&stepping->poses, &stepping->pose_capacity, bodies, sizeof *stepping->poses) ||
        !array_reserve((void **)&stepping->share, &stepping->share_capacity, contacts, sizeof *stepping->share) ||
        !array_reserve((void **)&stepping->separations, &stepping->separation_capacity, contacts,
                       sizeof *stepping->separations))
        return false;
    const Body *now = world_bodies(world);
    for (size_t i = 0; i < bodies; i++) {
        stepping->sweeps.bodies[i].x = now[i].velocity.x;
        stepping->sweeps.bodies[i].y = now[i].velocity.y;
        stepping->poses[i] = (BodyPose){now[i].position, now[i].angle};
    }
    const float share = 1.0f / (float)stepping->substeps;
    for (size_t i = 0; i < contacts; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        stepping->share[i] = (ContactImpulse){share * contact->warm_normal, share * contact->warm_tangent};
        stepping->separations[i] = contact->separation;
    }
    return true;
}

static void accelerate(Sweeps *sweeps, Vec2 change) {
    for (int i = 0; i < sweeps->body_count; i++) {
        SweepBody *body = &sweeps->bodies[i];
        if (body->inv_mass == 0) continue;
        body->x += change.x;
        body->y += change.y;
    }
}

static void integrate(Substepping *stepping, float dt) {
    for (int i = 0; i < stepping->sweeps.body_count; i++) {
        const SweepBody *body = &stepping->sweeps.bodies[i];
        BodyPose *pose = &stepping->poses[i];
        pose->position = vec2_add(pose->position, vec2_scale(dt, vec2(body->x, body->y)));
        pose->angle += dt * body->spin;
    }
}

/* Velocity along the normal, of b's point as seen from a's. */
static float normal_velocity(const Sweeps *sweeps, const ContactPoint *contact) {
    const SweepBody *a = &sweeps->bodies[contact->a], *b = &sweeps->bodies[contact->b];
    Vec2 of_a = vec2_add(vec2(a->x, a->y), scalar_cross_vec2(a->spin, contact->arm_a));
    Vec2 of_b = vec2_add(vec2(b->x, b->y), scalar_cross_vec2(b->spin, contact->arm_b));
    return vec2_dot(vec2_sub(of_b, of_a), contact->normal);
}

/* What the small step left of the overlaps is what the next pushes apart. inverse_dt: of the whole step. */
static void update_biases(Substepping *stepping, const ContactProblem *problem, float dt, float inverse_dt) {
    Sweeps *sweeps = &stepping->sweeps;
    for (int i = 0, contact = 0; i < sweeps->pair_count; i++)
        for (int k = 0; k < sweep_pair_points(&sweeps->pairs[i]); k++, contact++) {
            stepping->separations[contact] += dt * normal_velocity(sweeps, &problem->contacts[contact]);
            sweeps->pairs[i].points[k].bias = contact_bias(stepping->separations[contact], inverse_dt);
        }
}

static bool solve(Substepping *stepping, const Scene *scene, const ContactProblem *problem) {
    const float dt = problem->dt / (float)stepping->substeps;
    for (int i = 0; i < stepping->substeps; i++) {
        accelerate(&stepping->sweeps, vec2_scale(dt, scene->gravity));
        sweeps_push(&stepping->sweeps, stepping->share);
        if (!sweeps_run(&stepping->sweeps, stepping->sweeps_each)) return false;
        integrate(stepping, dt);
        if (scene->position_correction) update_biases(stepping, problem, dt, 1.0f / problem->dt);
    }
    return true;
}

static bool step(void *state, World *world, const Step *which, Error *error) {
    Substepping *stepping = state;
    ContactProblem problem;
    ContactSolution solution;
    if (!world_begin_step(world, which->scene->dt, &problem, &solution, error)) return false;
    step_solving_begins(which);
    bool solved = begin(stepping, world, &problem) && solve(stepping, which->scene, &problem);
    /* Where it is not finite the world refuses the step. */
    if (solved) sweeps_end(&stepping->sweeps, &solution);
    step_solving_ends(which);
    if (!solved) return error_memory(error, "substepping");
    return world_end_step_at(world, stepping->poses, error);
}

const SteppingKind stepping_substepping = {
    "substepping", "one collision pass, then small steps of sequential impulses", settings, create, step, destroy};
