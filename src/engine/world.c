/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The world: its bodies, and the step from contacts to new states. */
#include "base/base.h"
#include "engine/contact_set.h"
#include "engine/engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A step writes per-body data to arrays of body_capacity items, so that a failed step leaves `bodies` and `last`
   unchanged. */
struct World {
    WorldDef def;
    ContactRules rules;
    int body_count, bomb;
    int posed; /* bodies whose boxes and bounds are valid: for the pose in `moved`, after a failed step in `bodies` */
    size_t body_capacity;
    Body *bodies, *moved; /* before and after the step in progress */
    bool *fixed;
    float *friction;
    Box *boxes;
    Bounds *bounds;
    ProblemBody *problem_bodies;
    BodyVelocity *velocities;
    SortAndSweep broad_phase;
    PairList pairs;
    ContactSet last, next;
    ContactProblem problem;
    ContactSolution solution;
};

World *world_create(const WorldDef *def, Error *error) {
    World *world = calloc(1, sizeof *world);
    if (world == NULL) {
        error_memory(error, "world");
        return NULL;
    }
    world->def = *def;
    world->bomb = world->problem.bomb = -1;
    return world;
}

void world_destroy(World *world) {
    if (world == NULL) return;
    free(world->bodies);
    free(world->moved);
    free(world->fixed);
    free(world->friction);
    free(world->boxes);
    free(world->bounds);
    free(world->problem_bodies);
    free(world->velocities);
    sort_and_sweep_free(&world->broad_phase);
    free(world->pairs.pairs);
    contact_set_free(&world->last);
    contact_set_free(&world->next);
    free(world);
}

static bool reserve_bodies(World *world, size_t count) {
    struct {
        void **items;
        size_t size;
    } arrays[] = {{(void **)&world->bodies, sizeof(Body)},
                  {(void **)&world->moved, sizeof(Body)},
                  {(void **)&world->fixed, sizeof(bool)},
                  {(void **)&world->friction, sizeof(float)},
                  {(void **)&world->boxes, sizeof(Box)},
                  {(void **)&world->bounds, sizeof(Bounds)},
                  {(void **)&world->problem_bodies, sizeof(ProblemBody)},
                  {(void **)&world->velocities, sizeof(BodyVelocity)}};
    size_t capacity = world->body_capacity;
    bool ok = true;
    for (size_t i = 0; ok && i < sizeof arrays / sizeof arrays[0]; i++) {
        capacity = world->body_capacity;
        ok = array_reserve(arrays[i].items, &capacity, count, arrays[i].size);
    }
    if (ok) world->body_capacity = capacity;
    /* The arrays of the last step's problem and solution may have moved. */
    if (world->problem.bodies != NULL) world->problem.bodies = world->problem_bodies;
    if (world->solution.velocities != NULL) world->solution.velocities = world->velocities;
    return ok;
}

bool world_add_body(World *world, const BodyDef *def, Error *error) {
    if (!reserve_bodies(world, (size_t)world->body_count + 1)) return error_memory(error, "world");
    Body body = {def->position, def->angle, def->velocity, def->angular_velocity, def->size, def->friction, 0, 0};
    if (!def->fixed) {
        float inertia = def->mass * (def->size.x * def->size.x + def->size.y * def->size.y) / 12.0f;
        body.inv_mass = 1.0f / def->mass;
        body.inv_inertia = 1.0f / inertia;
    }
    world->fixed[world->body_count] = def->fixed;
    world->friction[world->body_count] = def->friction;
    world->bodies[world->body_count++] = body;
    return true;
}

void world_remove_last_body(World *world) {
    int body = --world->body_count;
    contact_set_forget(&world->last, body);
    /* A body added in its place must not reuse its box. */
    if (world->posed > body) world->posed = body;
    if (world->bomb == body) world->bomb = -1;
}

bool world_copy(World *to, const World *from, Error *error) {
    to->def = from->def;
    to->rules = from->rules;
    to->bomb = from->bomb;
    to->problem = (ContactProblem){.bomb = -1};
    to->posed = 0;
    to->body_count = from->body_count;
    if (!reserve_bodies(to, (size_t)from->body_count) || !contact_set_copy(&to->last, &from->last)) {
        to->body_count = 0;
        return error_memory(error, "world");
    }
    size_t count = (size_t)from->body_count;
    if (count == 0) return true;
    memcpy(to->bodies, from->bodies, count * sizeof *to->bodies);
    memcpy(to->fixed, from->fixed, count * sizeof *to->fixed);
    memcpy(to->friction, from->friction, count * sizeof *to->friction);
    return true;
}

void world_set_contacts(World *world, ContactRules rules) {
    if (rules.mend != world->rules.mend) world->posed = 0;
    world->rules = rules;
}
void world_set_bomb(World *world, int body) { world->bomb = body; }
int world_body_count(const World *world) { return world->body_count; }
const Body *world_bodies(const World *world) { return world->bodies; }
const ContactProblem *world_problem(const World *world) { return &world->problem; }
const ContactSolution *world_solution(const World *world) { return &world->solution; }
const int *world_contacts_before(const World *world) { return world->next.before; }

static bool collide(World *world) {
    for (int i = 0; i < world->body_count; i++) {
        const Body *body = &world->bodies[i], *before = &world->moved[i];
        if (i < world->posed && memcmp(&body->position, &before->position, sizeof body->position) == 0 &&
            memcmp(&body->angle, &before->angle, sizeof body->angle) == 0)
            continue;
        Box *box = &world->boxes[i];
        *box = box_make(body->position, body->size, body->angle);
        world->bounds[i] = contact_bounds(box, world->rules);
    }
    return sort_and_sweep_find(&world->broad_phase, &world->pairs, world->bounds, world->fixed, world->body_count) &&
           contact_set_collide(&world->next, &world->pairs, world->boxes, &world->last, world->rules);
}

bool world_begin_step(World *world, float dt, ContactProblem *problem, ContactSolution **solution, Error *error) {
    if (!collide(world))
        return world->broad_phase.too_many
                   ? error_input(error, "world", "more than %d pairs of boxes overlap; move the boxes apart",
                                 BROAD_PHASE_MAX_PAIRS)
                   : error_memory(error, "world");
    contact_set_match(&world->next, &world->last, world->rules, world->def.warm_starting);
    for (int i = 0; i < world->body_count; i++) { /* with gravity */
        const Body *body = &world->bodies[i];
        ProblemBody *out = &world->problem_bodies[i];
        *out = (ProblemBody){body->position, body->angle,           body->size, body->inv_mass, body->inv_inertia,
                             body->velocity, body->angular_velocity};
        if (body->inv_mass == 0.0f) continue;
        out->velocity = vec2_add(body->velocity, vec2_scale(dt, world->def.gravity));
        /* No torque, but this turns -0 into 0, as Box2D-Lite does. */
        out->angular_velocity += 0.0f;
    }
    contact_set_prepare(&world->next, world->problem_bodies, world->friction, dt, world->def.position_correction);
    *problem = (ContactProblem){.body_count = world->body_count,
                                .contact_count = world->next.contact_count,
                                .bomb = world->bomb,
                                .dt = dt,
                                .fall = sqrtf(vec2_dot(world->def.gravity, world->def.gravity)) * dt,
                                .bodies = world->problem_bodies,
                                .contacts = world->next.contacts};
    world->problem = *problem;
    world->solution = (ContactSolution){world->velocities, world->next.impulses, 0, {0}};
    *solution = &world->solution;
    return true;
}

bool world_end_step_at(World *world, const BodyPose *poses, Error *error) {
    const float dt = world->problem.dt;
    for (int i = 0; i < world->body_count; i++) {
        Body *body = &world->moved[i];
        *body = world->bodies[i];
        /* Semi-implicit Euler: with the new velocity. */
        body->velocity = world->velocities[i].linear;
        body->angular_velocity = world->velocities[i].angular;
        body->position = vec2_add(body->position, vec2_scale(dt, body->velocity));
        body->angle += dt * body->angular_velocity;
        if (poses == NULL) continue;
        body->position = poses[i].position;
        body->angle = poses[i].angle;
    }
    for (int i = 0; i < world->body_count; i++) {
        const Body *body = &world->moved[i];
        if (isfinite(body->position.x) && isfinite(body->position.y) && isfinite(body->angle) &&
            isfinite(body->velocity.x) && isfinite(body->velocity.y) && isfinite(body->angular_velocity))
            continue;
        return error_failure(error, FAILURE_NOT_FINITE, "world",
                             "the state of body %d is NaN or infinite (its velocity was %g, %g m/s)", i,
                             (double)world->bodies[i].velocity.x, (double)world->bodies[i].velocity.y);
    }
    /* The next step overwrites the old state. */
    Body *bodies = world->bodies;
    world->bodies = world->moved;
    world->moved = bodies;
    world->posed = world->body_count;
    const ContactSet last = world->last;
    world->last = world->next;
    world->next = last;
    return true;
}

bool world_end_step(World *world, Error *error) { return world_end_step_at(world, NULL, error); }

bool world_step(World *world, ContactSolve *solve, void *state, float dt, Error *error) {
    ContactProblem problem;
    ContactSolution *solution;
    return world_begin_step(world, dt, &problem, &solution, error) && solve(state, &problem, solution, error) &&
           world_end_step(world, error);
}

double body_energy(const Body *body, Vec2 gravity) {
    if (body->inv_mass == 0) return 0;
    double x = body->velocity.x, y = body->velocity.y, spin = body->angular_velocity;
    double potential = (double)gravity.x * body->position.x + (double)gravity.y * body->position.y;
    return (0.5 * (x * x + y * y) - potential) / body->inv_mass + 0.5 * spin * spin / body->inv_inertia;
}

double world_energy(const World *world, Vec2 gravity) {
    double sum = 0;
    for (int i = 0; i < world_body_count(world); i++) sum += body_energy(&world_bodies(world)[i], gravity);
    return sum;
}

double world_penetration(const World *world) {
    const ContactProblem *problem = world_problem(world);
    double depth = 0;
    for (int i = 0; i < problem->contact_count; i++)
        if (-problem->contacts[i].separation > depth) depth = -problem->contacts[i].separation;
    return depth;
}
