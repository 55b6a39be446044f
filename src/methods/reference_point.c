/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference (methods/reference.h): packs a contact problem into groups of four contacts, solves it
   (reference_code.h), measures the error of a method, and is a method itself. */
#include "base/base.h"
#include "base/random.h"
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/impulses.h"
#include "methods/islands.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/reference_parts.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Without friction, a cone this narrow: its inside is not empty. */
static const double friction_min = 1e-12;

void reference_free(Reference *r) {
    block_graph_free(&r->graph);
    free(r->memory.memory);
    *r = (Reference){0};
}

static bool reserve(Reference *r, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    const size_t pairs = contacts + BLOCK_PAIRS, groups = pairs / BLOCK_PAIRS + 1;
    return block_graph_reserve(&r->graph, problem->body_count, problem->contact_count) &&
           ARRAY_BLOCK_RESERVE(&r->memory, ARRAY_PART(r->velocities, bodies), ARRAY_PART(r->impulses, contacts),
                               ARRAY_PART(r->other_velocities, bodies), ARRAY_PART(r->other_impulses, contacts),
                               ARRAY_PART(r->groups, groups), ARRAY_PART(r->pairs, pairs), ARRAY_PART(r->first, pairs),
                               ARRAY_PART(r->kept[0].points, groups), ARRAY_PART(r->kept[1].points, groups),
                               ARRAY_PART(r->kept[0].moved, bodies), ARRAY_PART(r->kept[1].moved, bodies),
                               ARRAY_PART(r->moved, bodies), ARRAY_PART(r->changes, bodies),
                               ARRAY_PART(r->first_changes, bodies));
}

/* Pairs of one or two contacts, in the order of the problem. */
static void find_pairs(Reference *r, const ContactProblem *problem) {
    r->pair_count = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const bool same = i > 0 && contact[-1].a == contact->a && contact[-1].b == contact->b;
        if (same && r->first[r->pair_count - 1] == i - 1) continue;
        r->graph.ends[r->pair_count] = (BlockEdge){contact->a, contact->b};
        r->first[r->pair_count++] = i;
    }
    r->first[r->pair_count] = problem->contact_count;
    r->group_count = (r->pair_count + BLOCK_PAIRS - 1) / BLOCK_PAIRS;
}

static void load_slot(ReferenceGroup *group, int slot, BlockPair *pair, int k, const ContactProblem *problem, int i,
                      bool push_out) {
    const ContactPoint *contact = &problem->contacts[i];
    const double friction = (double)contact->friction;
    const double bias = push_out || contact->bias < 0 ? (double)contact->bias : 0;
    const Vec4 before = block_pair_velocity(&problem->bodies[contact->a], &problem->bodies[contact->b]);
    block_rows_load(&group->rows, slot, pair, k, contact->normal, contact->arm_a, contact->arm_b);
    group->weight[slot] = 1;
    group->mass_normal[slot] = (double)contact->mass_normal;
    group->mass_tangent[slot] = (double)contact->mass_tangent;
    group->inverse_normal[slot] = 1 / (double)contact->mass_normal;
    group->inverse_tangent[slot] = 1 / (double)contact->mass_tangent;
    group->friction[slot] = friction > friction_min ? friction : friction_min;
    group->free_normal[slot] = sum4(pair->normal[k] * before) - bias;
    group->free_tangent[slot] = sum4(pair->tangent[k] * before);
}

/* The problem, without impulses. False when memory is short. */
static bool load(Reference *r, const ContactProblem *problem) {
    if (!reserve(r, problem)) return false;
    find_pairs(r, problem);
    if (!block_graph_load(&r->graph, problem, r->pair_count)) return false;
    const int32_t none = r->graph.lu.count, spare = block_lu_spare(&r->graph.lu);
    Vec4 *const numbers[] = {r->moved, r->changes, r->first_changes, r->kept[0].moved, r->kept[1].moved};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) numbers[i][none] = (Vec4){0};
    r->contact_count = r->factorizations = r->attempts = 0;
    const Vec4 one = {1, 1, 1, 1};
    for (int i = 0; i < r->group_count; i++) { /* slots that take part in all operations and have no effect */
        r->groups[i] = (ReferenceGroup){.mass_normal = one, .mass_tangent = one, .friction = one, .free_normal = one};
        r->groups[i].now = (ReferencePoint){.l = one, .u = one, .w = one, .z = one, .p = one, .q = one};
    }
    for (int i = 0; i < BLOCK_PAIRS * r->group_count; i++)
        r->pairs[i] = (BlockPair){.a = none, .b = none, .place = {spare, spare}};
    for (int i = 0; i < r->pair_count; i++) {
        BlockPair *pair = &r->pairs[i];
        const int first = r->first[i], count = r->first[i + 1] - first;
        if (!block_graph_place(&r->graph, i, pair)) continue; /* it changes nothing, as its bodies are fixed */
        r->contact_count += count;
        for (int k = 0; k < count; k++)
            load_slot(&r->groups[i / BLOCK_PAIRS], i % BLOCK_PAIRS * 2 + k, pair, k, problem, first + k, r->push_out);
    }
    return true;
}

/* The warm start, or the given impulses, as `normal` and `tangent`. */
static void set_start(Reference *r, const ContactProblem *problem, const ContactImpulse *given) {
    for (int i = 0; i < r->pair_count; i++)
        for (int x = r->first[i], slot = i % BLOCK_PAIRS * 2; x < r->first[i + 1]; x++, slot++) {
            const ContactPoint *contact = &problem->contacts[x];
            ReferenceGroup *group = &r->groups[i / BLOCK_PAIRS];
            group->normal[slot] = (double)(given != NULL ? given[x].normal : contact->warm_normal);
            group->tangent[slot] = (double)(given != NULL ? given[x].tangent : contact->warm_tangent);
        }
}

static void store(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->pair_count; i++)
        for (int x = r->first[i], slot = i % BLOCK_PAIRS * 2; x < r->first[i + 1]; x++, slot++) {
            const ReferenceGroup *group = &r->groups[i / BLOCK_PAIRS];
            const double normal = group->normal[slot], tangent = group->tangent[slot];
            const double limit = (double)problem->contacts[x].friction * normal;
            r->impulses[x] = (ReferenceImpulse){normal, tangent > limit ? limit : tangent < -limit ? -limit : tangent};
        }
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const Vec4 moved = r->moved[block_graph_position(&r->graph, i)];
        r->velocities[i] = (ReferenceVelocity){(double)body->velocity.x + moved[0], (double)body->velocity.y + moved[1],
                                               (double)body->angular_velocity + moved[2]};
    }
}

static const ReferenceKernels *kernels(const Reference *r) {
#ifdef TWINBOX_AVX
    if (!r->scalar && sweeps_can(SWEEP_LANES)) return &reference_avx2;
#endif
    (void)r;
    return &reference_scalar;
}

static bool solve_scaled(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    if (!load(r, problem)) return error_memory(error, "reference");
    set_start(r, problem, start);
    kernels(r)->run(r);
    store(r, problem);
    return true;
}

/* The share of the change of velocity that has the least kinetic energy if the whole of it adds some, else 1: energy is
   a square in the share, and at the share 0 what it was before. */
static double share_without_gain(const Reference *r, const ContactProblem *problem) {
    double across = 0, square = 0; /* m v dv and m dv dv */
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const double x = (double)body->velocity.x, y = (double)body->velocity.y, spin = (double)body->angular_velocity;
        const double dx = r->velocities[i].x - x, dy = r->velocities[i].y - y, turn = r->velocities[i].spin - spin;
        if (body->inv_mass > 0) {
            across += (x * dx + y * dy) / (double)body->inv_mass;
            square += (dx * dx + dy * dy) / (double)body->inv_mass;
        }
        if (body->inv_inertia > 0) {
            across += spin * turn / (double)body->inv_inertia;
            square += turn * turn / (double)body->inv_inertia;
        }
    }
    return 2 * across + square <= 0 ? 1 : across < 0 ? -across / square : 0;
}

/* Shortens the answer so far that it adds no energy, and finds its residual. */
static bool take_without_gain(Reference *r, const ContactProblem *problem, Error *error) {
    const double share = share_without_gain(r, problem);
    r->push_out = true;
    if (!load(r, problem)) return error_memory(error, "reference");
    for (int i = 0; i < problem->contact_count; i++) {
        r->impulses[i].normal *= share;
        r->impulses[i].tangent *= share;
    }
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        ReferenceVelocity *v = &r->velocities[i];
        v->x = (double)body->velocity.x + share * (v->x - (double)body->velocity.x);
        v->y = (double)body->velocity.y + share * (v->y - (double)body->velocity.y);
        v->spin = (double)body->angular_velocity + share * (v->spin - (double)body->angular_velocity);
    }
    for (int i = 0; i < r->pair_count; i++)
        for (int x = r->first[i], slot = i % BLOCK_PAIRS * 2; x < r->first[i + 1]; x++, slot++) {
            r->groups[i / BLOCK_PAIRS].normal[slot] = r->impulses[x].normal;
            r->groups[i / BLOCK_PAIRS].tangent[slot] = r->impulses[x].tangent;
        }
    r->residual = kernels(r)->residual(r);
    return true;
}

/* Of a step without a solution: see reference.h. */
static bool answer_unsolved(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    const size_t impulses = (size_t)problem->contact_count * sizeof *r->impulses;
    const size_t velocities = (size_t)problem->body_count * sizeof *r->velocities;
    const int factorizations = r->factorizations, attempts = r->attempts;
    if (!take_without_gain(r, problem, error)) return false;
    const double residual = r->residual;
    memcpy(r->other_impulses, r->impulses, impulses);
    memcpy(r->other_velocities, r->velocities, velocities);
    r->push_out = false;
    if (!solve_scaled(r, problem, start, error)) return false;
    const int more = r->factorizations;
    if (!take_without_gain(r, problem, error)) return false;
    r->factorizations = factorizations + more;
    r->attempts = attempts;
    if (!(residual < r->residual)) return true;
    r->residual = residual;
    memcpy(r->impulses, r->other_impulses, impulses);
    memcpy(r->velocities, r->other_velocities, velocities);
    return true;
}

bool reference_solve(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    r->aim = REFERENCE_TOLERANCE / 10;
    r->enough = REFERENCE_TOLERANCE / 4;
    r->calm = 0.01;
    r->most = REFERENCE_MOST;
    r->persist = r->push_out = true;
    r->by_heaviest = false;
    if (!solve_scaled(r, problem, start, error)) return false;
    r->residual = kernels(r)->residual(r);
    return r->residual <= near_solution * r->calm || answer_unsolved(r, problem, start, error);
}

bool reference_solve_to(Reference *r, const ContactProblem *problem, const ReferenceAim *aim, Error *error) {
    r->aim = r->enough = aim->tolerance;
    r->calm = 20 * aim->tolerance;
    r->most = aim->most;
    r->persist = false;
    r->push_out = aim->push_out;
    r->by_heaviest = aim->by_heaviest;
    if (!solve_scaled(r, problem, NULL, error)) return false;
    r->residual = r->best;
    return true;
}

void reference_round(const Reference *r, const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *velocity = &r->velocities[i];
        solution->velocities[i] = (BodyVelocity){vec2((float)velocity->x, (float)velocity->y), (float)velocity->spin};
    }
    for (int i = 0; i < problem->contact_count; i++)
        solution->impulses[i] = (ContactImpulse){(float)r->impulses[i].normal, (float)r->impulses[i].tangent};
}

bool reference_residual(Reference *r, const ContactProblem *problem, const ContactImpulse *impulses, double *residual,
                        Error *error) {
    r->push_out = true;
    if (!load(r, problem)) return error_memory(error, "reference");
    set_start(r, problem, impulses);
    *residual = kernels(r)->residual(r);
    return true;
}

/* |u - v|^2 with a weight for the spin's square. */
static double squared_distance(const ReferenceVelocity *u, const ReferenceVelocity *v, double spin_weight) {
    double x = u->x - v->x, y = u->y - v->y, spin = u->spin - v->spin;
    return x * x + y * y + spin_weight * (spin * spin);
}

SolutionError solution_error(const ContactProblem *problem, const BodyVelocity *velocities,
                             const ReferenceVelocity *reference) {
    SolutionError error = {.worst = -1};
    double sum = 0, most = -1;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (body->inv_mass == 0.0f) continue;
        ReferenceVelocity freely = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
        ReferenceVelocity found = {(double)velocities[i].linear.x, (double)velocities[i].linear.y,
                                   (double)velocities[i].angular};
        const double square = squared_distance(&found, &reference[i], 1.0 / 6.0);
        sum += square;
        if (!(square <= most)) { /* NaN is worst */
            most = square;
            error.worst = i;
        }
        const double least = 0.05 * 0.05, part = 0.05 * 0.05, half_spin = 0.25;
        const double of_change = part * squared_distance(&reference[i], &freely, half_spin);
        error.right += squared_distance(&found, &reference[i], half_spin) <= (of_change > least ? of_change : least);
        error.counted++;
    }
    if (error.counted > 0) error.rms = isnan(sum) ? INFINITY : sqrt(sum / error.counted);
    return error;
}

static double distance(const ContactProblem *problem, const ReferenceVelocity *u, const ReferenceVelocity *v) {
    double sum = 0;
    int counted = 0;
    for (int i = 0; i < problem->body_count; i++) {
        if (problem->bodies[i].inv_mass == 0.0f) continue;
        sum += squared_distance(&u[i], &v[i], 1.0 / 6.0);
        counted++;
    }
    return counted > 0 ? sqrt(sum / counted) : 0;
}

/* What sweeps make of no impulses: a solver's way to another answer. False when memory is short. */
static bool sweep_from_nothing(const ContactProblem *problem, ContactImpulse *impulses) {
    enum { SWEEPS = 30 };
    const SequentialOptions cold = {.accumulate = true};
    ContactSolution solution = {calloc((size_t)problem->body_count + 1, sizeof *solution.velocities), impulses, 0, {0}};
    if (solution.velocities == NULL) return false;
    sequential_impulses_begin(problem, &cold, &solution);
    for (int i = 0; i < SWEEPS; i++) sequential_impulses_visit(problem, &cold, 0, problem->contact_count, &solution);
    free(solution.velocities);
    return true;
}

/* N s: the largest normal impulse of the answer, or what could turn a contact's velocity back, if that is more. */
static double largest_impulse(const ContactProblem *problem, const Reference *answer) {
    double most = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
        const Vec2 before = contact_relative_velocity(&(BodyVelocity){a->velocity, a->angular_velocity},
                                                      &(BodyVelocity){b->velocity, b->angular_velocity}, contact);
        const double speed = sqrt((double)vec2_dot(before, before));
        most = fmax(most, fmax(answer->impulses[i].normal, (double)contact->mass_normal * speed));
    }
    return most;
}

bool reference_raise_floor(Reference *r, const ContactProblem *problem, const Reference *answer,
                           const ContactImpulse *start, double *floor, Error *error) {
    if (!reference_solve(r, problem, start, error)) return false;
    if (reference_converged(r)) *floor = fmax(*floor, distance(problem, r->velocities, answer->velocities));
    return true;
}

bool reference_floor(Reference *r, const ContactProblem *problem, const Reference *answer, int starts, double *floor,
                     Error *error) {
    const double most = largest_impulse(problem, answer);
    ContactImpulse *start = calloc((size_t)problem->contact_count + 1, sizeof *start);
    bool ok = start != NULL || error_memory(error, "reference");
    uint64_t random = 1;
    *floor = 0;
    for (int k = 0; ok && k < starts; k++) {
        if (k == 1) ok = sweep_from_nothing(problem, start) || error_memory(error, "reference");
        for (int i = 0; k > 1 && i < problem->contact_count; i++) {
            const double normal = most * random_unit(&random);
            const double tangent = (double)problem->contacts[i].friction * normal * random_signed(&random);
            start[i] = (ContactImpulse){(float)normal, (float)tangent};
        }
        ok = ok && reference_raise_floor(r, problem, answer, start, floor, error);
    }
    free(start);
    return ok;
}

/* The reference (methods/reference.h) as a contact solver, for runs of converged steps. A step that does not
   converge ends with the answer that reference.h states, and is counted. */

typedef struct State {
    Reference reference;
    Islands islands;
} State;

static void *create(const Settings *chosen, Error *error) {
    (void)chosen;
    State *state = calloc(1, sizeof *state);
    if (state == NULL) error_memory(error, "reference");
    return state;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    Reference *reference = &solver->reference;
    if (!reference_solve(reference, problem, NULL, error)) return false;
    reference_round(reference, problem, solution);
    if (!islands_take_gain(&solver->islands, problem, solution)) return error_memory(error, "reference");
    if (solver->islands.shortened &&
        !reference_residual(reference, problem, solution->impulses, &reference->residual, error))
        return false;
    solution->fallbacks = (Fallbacks){0};
    if (!reference_converged(reference))
        solution->fallbacks = (Fallbacks){.not_converged = 1, .residual = reference->residual};
    return true;
}

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    reference_free(&solver->reference);
    islands_free(&solver->islands);
    free(solver);
}

static const SettingSpec settings[] = {KEEP_SETTING(SETTING_OWN), {0}};

const ContactSolverKind solver_reference = {
    .description = {.name = "reference",
                    .summary = "the converged solution, by interior points in double; errors are measured against it",
                    .caption = "converged solution",
                    .role = METHOD_REFERENCE,
                    .settings = settings,
                    .converges = "",
                    .stability_place = 6},
    .create = create,
    .solve = solve,
    .destroy = destroy};
