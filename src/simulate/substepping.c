/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Substepping: one collision pass, then n small steps of dt / n, each with gravity, k sweeps of sequential impulses and
   integration (Macklin et al., "Small Steps in Physics Simulation", 2019; the TGS of PhysX and Box2D v3).

   Contact points stay fixed on the bodies for the whole step: normals, lever arms and effective masses are those of
   the collision pass, and a separation changes by the velocity along its normal. The velocity that pushes an overlap
   apart is that of the whole step, so that the step ends with the velocities that a converged solve of the whole step
   has. The impulses handed on, and stored, are those of the last small step.

   Fails like k sweeps of a step n times as short: what it gains is that errors of one small step are seen by the next.
   Where a single impact has to travel through a stack it is about as good as n k sweeps, and dearer. */
#include "common/array.h"
#include "dynamics/contacts.h"
#include "simulate/stepping.h"
#include "solvers/solvers.h"

#include <stdlib.h>
#include <string.h>

typedef struct Substepping {
    int substeps;
    ContactSolver solver;
    ProblemBody *bodies;    /* as they are in the small step */
    ContactPoint *contacts; /* the same */
    BodyPose *poses;
    size_t body_capacity, contact_capacity, pose_capacity;
} Substepping;

static const SettingSpec settings[] = {
    {"substeps", "small steps a step (4)"}, {"k", "sweeps a small step (1)"}, {NULL, NULL}};

static void destroy(void *state) {
    Substepping *stepping = state;
    if (stepping->solver.state != NULL) stepping->solver.kind->destroy(stepping->solver.state);
    free(stepping->bodies);
    free(stepping->contacts);
    free(stepping->poses);
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
    stepping->solver.kind = &solver_sequential_impulses;
    Settings sweeps = {0};
    const char *k = settings_get(chosen, "k");
    settings_default(&sweeps, "k", k == NULL ? "1" : k);
    if (settings_int(chosen, "substeps", 1, 1000, &stepping->substeps, error))
        stepping->solver.state = stepping->solver.kind->create(&sweeps, error);
    if (stepping->solver.state != NULL) return stepping;
    destroy(stepping);
    return NULL;
}

/* The bodies before gravity, the contacts as they are. */
static bool begin(Substepping *stepping, const World *world, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (!array_reserve((void **)&stepping->bodies, &stepping->body_capacity, bodies, sizeof *stepping->bodies) ||
        !array_reserve((void **)&stepping->poses, &stepping->pose_capacity, bodies, sizeof *stepping->poses) ||
        !array_reserve((void **)&stepping->contacts, &stepping->contact_capacity, contacts, sizeof *stepping->contacts))
        return false;
    const Body *now = world_bodies(world);
    for (size_t i = 0; i < bodies; i++) {
        stepping->bodies[i] = problem->bodies[i];
        stepping->bodies[i].velocity = now[i].velocity;
        stepping->bodies[i].angular_velocity = now[i].angular_velocity;
    }
    if (contacts > 0) memcpy(stepping->contacts, problem->contacts, contacts * sizeof *stepping->contacts);
    return true;
}

static void accelerate(Substepping *stepping, int count, Vec2 gravity, float dt) {
    for (int i = 0; i < count; i++) {
        ProblemBody *body = &stepping->bodies[i];
        if (body->inv_mass > 0) body->velocity = vec2_add(body->velocity, vec2_scale(dt, gravity));
    }
}

/* The solution's velocities carry the bodies. */
static void integrate(Substepping *stepping, const ContactProblem *problem, const ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++) {
        ProblemBody *body = &stepping->bodies[i];
        body->velocity = solution->velocities[i].linear;
        body->angular_velocity = solution->velocities[i].angular;
        body->position = vec2_add(body->position, vec2_scale(problem->dt, body->velocity));
        body->angle += problem->dt * body->angular_velocity;
        stepping->poses[i] = (BodyPose){body->position, body->angle};
    }
}

/* What the small step left of the overlaps is what the next pushes apart; its impulses are what the next starts from.
   correct_in: time, s, in which position correction would undo them; 0 without it. */
static void carry_contacts(Substepping *stepping, const ContactProblem *problem, const ContactSolution *solution,
                           float correct_in) {
    for (int i = 0; i < problem->contact_count; i++) {
        ContactPoint *contact = &stepping->contacts[i];
        const BodyVelocity *a = &solution->velocities[contact->a], *b = &solution->velocities[contact->b];
        Vec2 of_a = vec2_add(a->linear, scalar_cross_vec2(a->angular, contact->arm_a));
        Vec2 of_b = vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b));
        float moved = problem->dt * vec2_dot(vec2_sub(of_b, of_a), contact->normal);
        contact->separation += moved;
        if (correct_in > 0) contact->bias = contact_bias(contact->separation, 1.0f / correct_in);
        contact->warm_normal = solution->impulses[i].normal;
        contact->warm_tangent = solution->impulses[i].tangent;
    }
}

static bool solve_small_steps(Substepping *stepping, const Scene *scene, const ContactProblem *whole,
                              ContactSolution *solution, Error *error) {
    ContactProblem problem = *whole;
    problem.dt = whole->dt / (float)stepping->substeps;
    problem.bodies = stepping->bodies;
    problem.contacts = stepping->contacts;
    for (int i = 0; i < stepping->substeps; i++) {
        accelerate(stepping, problem.body_count, scene->gravity, problem.dt);
        if (!stepping->solver.kind->solve(stepping->solver.state, &problem, solution, error)) return false;
        integrate(stepping, &problem, solution);
        carry_contacts(stepping, &problem, solution, scene->position_correction ? whole->dt : 0);
    }
    return true;
}

static bool step(void *state, World *world, const Step *which, Error *error) {
    Substepping *stepping = state;
    ContactProblem problem;
    ContactSolution solution;
    if (!world_begin_step(world, which->scene->dt, &problem, &solution, error)) return false;
    step_solving_begins(which);
    bool solved = begin(stepping, world, &problem);
    if (!solved) error_memory(error, "substepping");
    solved = solved && solve_small_steps(stepping, which->scene, &problem, &solution, error);
    step_solving_ends(which);
    return solved && world_end_step_at(world, stepping->poses, error);
}

const SteppingKind stepping_substepping = {
    "substepping", "one collision pass, then small steps of sequential impulses", settings, create, step, destroy};
