/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Substepping: one collision pass, then n small steps of dt / n, each with its share of gravity, k sweeps of sequential
   impulses, and integration (Macklin et al., "Small Steps in Physics Simulation", 2019; temporal Gauss-Seidel).

   Normals, lever arms and effective masses stay those of the collision pass; a separation changes by the velocity along
   its normal. Impulses accumulate over the whole step and are clamped as a sum, so that an impulse that stops a fall in
   one small step is not applied again in the next. The warm start is applied in n equal shares, as gravity is. The bias
   velocity that corrects penetration is that of the whole step: so the step ends with the velocities of a converged
   solve of the whole step.

   Fails as n k sweeps of one whole step do: a shock travels no further through a stack. It is slower, because sweeps of
   different small steps cannot overlap. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "methods/sweeps.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Substepping {
    int substeps, sweeps_each;
    Sweeps sweeps;
    BodyPose *poses;       /* [bodies] */
    BodyVelocity *pushes;  /* [bodies] change by gravity and warm start in each small step */
    ContactImpulse *share; /* [contacts] share of the warm start in each small step */
    float *separations;    /* [contacts] current */
    ArrayBlock arrays;
} Substepping;

static const SettingSpec settings[] = {
    {"substeps", "small steps per step (default: 4)", SETTING_INT(Substepping, substeps, 1, 1000)},
    {"k", "sweeps per small step (default: 1)", SETTING_INT(Substepping, sweeps_each, 1, SWEEPS_MAX)},
    {0}};

static void substepping_destroy(void *state) {
    Substepping *stepping = state;
    sweeps_free(&stepping->sweeps);
    free(stepping->arrays.memory);
    free(stepping);
}

static void *substepping_create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Substepping standard = {.substeps = 4, .sweeps_each = 1};
    (void)scene;
    return settings_make(chosen, settings, &standard, sizeof standard, "substepping", error);
}

static bool substepping_reserve(Substepping *stepping, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    return ARRAY_BLOCK_RESERVE(&stepping->arrays, ARRAY_PART(stepping->poses, bodies),
                               ARRAY_PART(stepping->pushes, bodies), ARRAY_PART(stepping->share, contacts),
                               ARRAY_PART(stepping->separations, contacts));
}

/* The same for every small step, as arms and masses do not change. */
static void find_pushes(Substepping *stepping, Vec2 gravity) {
    Sweeps *sweeps = &stepping->sweeps;
    for (int i = 0; i < sweeps->body_count; i++) {
        SweepBody *body = &sweeps->bodies[i];
        Vec2 fall = body->inv_mass > 0 ? gravity : vec2(0, 0);
        stepping->pushes[i] = (BodyVelocity){vec2(body->x, body->y), body->spin};
        body->x += fall.x;
        body->y += fall.y;
    }
    sweeps_push(sweeps, stepping->share);
    for (int i = 0; i < sweeps->body_count; i++) {
        SweepBody *body = &sweeps->bodies[i];
        BodyVelocity *push = &stepping->pushes[i], before = *push;
        *push = (BodyVelocity){vec2(body->x - before.linear.x, body->y - before.linear.y), body->spin - before.angular};
    }
}

/* Bodies before gravity, plus the push of the first small step; contacts from the collision pass. */
static bool substepping_begin(Substepping *stepping, const World *world, const ContactProblem *problem, Vec2 gravity) {
    if (!substepping_reserve(stepping, problem) ||
        !sweeps_begin(&stepping->sweeps, sweeps_best_kernel(), problem, false))
        return false;
    const Body *now = world_bodies(world);
    for (int i = 0; i < problem->body_count; i++) {
        stepping->sweeps.bodies[i].x = now[i].velocity.x;
        stepping->sweeps.bodies[i].y = now[i].velocity.y;
        stepping->poses[i] = (BodyPose){now[i].position, now[i].angle};
    }
    const float share = 1.0f / (float)stepping->substeps;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        stepping->share[i] = (ContactImpulse){share * contact->warm_normal, share * contact->warm_tangent};
        stepping->separations[i] = contact->separation;
    }
    find_pushes(stepping, vec2_scale(share * problem->dt, gravity));
    return true;
}

/* Applies gravity and warm start of one more small step. */
static void substepping_push(Substepping *stepping) {
    Sweeps *sweeps = &stepping->sweeps;
    for (int i = 0; i < sweeps->body_count; i++) {
        SweepBody *body = &sweeps->bodies[i];
        body->x += stepping->pushes[i].linear.x;
        body->y += stepping->pushes[i].linear.y;
        body->spin += stepping->pushes[i].angular;
    }
    const ContactImpulse *share = stepping->share;
    for (int i = 0; i < sweeps->pair_count; i++)
        for (int k = 0; k < sweep_pair_points(&sweeps->pairs[i]); k++, share++) {
            sweeps->pairs[i].sums[k].normal += share->normal;
            sweeps->pairs[i].sums[k].tangent += share->tangent;
        }
}

static void substepping_integrate(Substepping *stepping, float dt) {
    for (int i = 0; i < stepping->sweeps.body_count; i++) {
        const SweepBody *body = &stepping->sweeps.bodies[i];
        BodyPose *pose = &stepping->poses[i];
        pose->position = vec2_add(pose->position, vec2_scale(dt, vec2(body->x, body->y)));
        pose->angle += dt * body->spin;
    }
}

/* Velocity of b's point relative to a's, along the normal. */
static float normal_velocity(const Sweeps *sweeps, const ContactPoint *contact) {
    const SweepBody *a = &sweeps->bodies[contact->a], *b = &sweeps->bodies[contact->b];
    Vec2 of_a = vec2_add(vec2(a->x, a->y), scalar_cross_vec2(a->spin, contact->arm_a));
    Vec2 of_b = vec2_add(vec2(b->x, b->y), scalar_cross_vec2(b->spin, contact->arm_b));
    return vec2_dot(vec2_sub(of_b, of_a), contact->normal);
}

/* The next small step corrects the penetration that remains. inverse_dt: of the whole step. */
static void update_biases(Substepping *stepping, const ContactProblem *problem, float dt, float inverse_dt) {
    Sweeps *sweeps = &stepping->sweeps;
    for (int i = 0, contact = 0; i < sweeps->pair_count; i++)
        for (int k = 0; k < sweep_pair_points(&sweeps->pairs[i]); k++, contact++) {
            stepping->separations[contact] += dt * normal_velocity(sweeps, &problem->contacts[contact]);
            sweeps->pairs[i].points[k].bias = contact_bias(stepping->separations[contact], inverse_dt);
        }
}

static bool substepping_solve(void *state, BegunStep *begun, Error *error) {
    Substepping *stepping = state;
    const Scene *scene = begun->step->scene;
    const ContactProblem *problem = begun->problem;
    const float dt = problem->dt / (float)stepping->substeps;
    if (!substepping_begin(stepping, begun->world, problem, scene->gravity)) return error_memory(error, "substepping");
    for (int i = 0; i < stepping->substeps; i++) {
        if (i > 0) substepping_push(stepping);
        if (!sweeps_run(&stepping->sweeps, stepping->sweeps_each)) return error_memory(error, "substepping");
        substepping_integrate(stepping, dt);
        if (scene->position_correction) update_biases(stepping, problem, dt, 1.0f / problem->dt);
    }
    sweeps_end(&stepping->sweeps, begun->solution); /* the world refuses a NaN or infinite result */
    begun->poses = stepping->poses;
    return true;
}

const SteppingKind stepping_substepping = {
    .description = {.name = "substepping",
                    .summary = "one collision pass, then small steps of sequential impulses",
                    .caption = "small steps of sequential impulses",
                    .settings = settings,
                    .own_settings = "substeps=4,k=1",
                    .chart = METHOD_RUNS("substeps=2", "substeps=4,k=4", "substeps=10", "substeps=8,k=16",
                                         "substeps=32,k=16"),
                    .chart_quick = METHOD_RUNS("substeps=10"),
                    .stability_place = 4},
    .create = substepping_create,
    .solve = substepping_solve,
    .destroy = substepping_destroy};
