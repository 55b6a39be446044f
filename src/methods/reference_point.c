/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/sweeps.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Packs contact problems into groups of four contacts. */
#include "methods/reference_parts.h"

enum { NUMBERS = 7 }; /* arrays of one Vec4 for each body */

/* Without friction, a cone this narrow: its inside is not empty. */
static const double friction_min = 1e-12;
/* kg, kg m^2: of what cannot move in one of its directions. */
static const double mass_max = 1e20;

void reference_free(Reference *r) {
    block_lu_free(&r->lu);
    void *arrays[] = {r->velocities, r->impulses, r->groups,  r->pairs,  r->bodies,
                      r->nodes,      r->edges,    r->edge_of, r->points, r->numbers};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *r = (Reference){0};
}

static bool reserve(Reference *r, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    const size_t pairs = contacts + REFERENCE_PAIRS, groups = pairs / REFERENCE_PAIRS + 1;
    if (!array_reserve((void **)&r->velocities, &r->velocity_capacity, bodies, sizeof *r->velocities) ||
        !array_reserve((void **)&r->impulses, &r->impulse_capacity, contacts, sizeof *r->impulses) ||
        !array_reserve((void **)&r->groups, &r->group_capacity, groups, sizeof *r->groups) ||
        !array_reserve((void **)&r->pairs, &r->pair_capacity, pairs, sizeof *r->pairs) ||
        !array_reserve((void **)&r->bodies, &r->body_capacity, bodies, sizeof *r->bodies) ||
        !array_reserve((void **)&r->nodes, &r->node_capacity, bodies, sizeof *r->nodes) ||
        !array_reserve((void **)&r->edges, &r->edge_capacity, pairs, sizeof *r->edges) ||
        !array_reserve((void **)&r->edge_of, &r->edge_of_capacity, pairs, sizeof *r->edge_of) ||
        !array_reserve((void **)&r->points, &r->point_capacity, KEPT * groups, sizeof *r->points) ||
        !array_reserve((void **)&r->numbers, &r->number_capacity, NUMBERS * bodies, sizeof *r->numbers))
        return false;
    Vec4 **arrays[NUMBERS] = {&r->masses,        &r->inverses,      &r->moved,        &r->changes,
                              &r->first_changes, &r->kept[0].moved, &r->kept[1].moved};
    for (size_t i = 0; i < NUMBERS; i++) *arrays[i] = r->numbers + i * bodies;
    for (size_t i = 0; i < KEPT; i++) r->kept[i].points = r->points + i * groups;
    return true;
}

/* Nodes are the moving bodies that touch something, in the order of the bodies. Returns their number. */
static int number_bodies(Reference *r, const ContactProblem *problem) {
    memset(r->nodes, 0, (size_t)problem->body_count * sizeof *r->nodes);
    for (int i = 0; i < problem->contact_count; i++)
        r->nodes[problem->contacts[i].a] = r->nodes[problem->contacts[i].b] = 1;
    int count = 0;
    for (int i = 0; i < problem->body_count; i++)
        r->nodes[i] = r->nodes[i] && problem_body_moves(&problem->bodies[i]) ? count++ : -1;
    return count;
}

/* Pairs of one or two contacts, in the order of the problem. */
static void find_pairs(Reference *r, const ContactProblem *problem) {
    r->pair_count = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const bool same = i > 0 && contact[-1].a == contact->a && contact[-1].b == contact->b;
        if (same && r->pairs[r->pair_count - 1].count == 1)
            r->pairs[r->pair_count - 1].count++;
        else
            r->pairs[r->pair_count++] = (ReferencePair){.first = i, .count = 1};
    }
    r->group_count = (r->pair_count + REFERENCE_PAIRS - 1) / REFERENCE_PAIRS;
    r->pairs[r->pair_count] = (ReferencePair){0};
}

static bool analyse(Reference *r, const ContactProblem *problem) {
    const int count = number_bodies(r, problem);
    find_pairs(r, problem);
    int edges = 0;
    for (int i = 0; i < r->pair_count; i++) {
        const ContactPoint *contact = &problem->contacts[r->pairs[i].first];
        const int a = r->nodes[contact->a], b = r->nodes[contact->b];
        r->edge_of[i] = a >= 0 && b >= 0 ? edges : -1;
        if (r->edge_of[i] >= 0) r->edges[edges++] = (BlockEdge){a, b};
    }
    return block_lu_analyse(&r->lu, count, r->edges, edges);
}

static double mass_of(float inverse) { return inverse > 0 ? 1 / (double)inverse : mass_max; }

static void load_bodies(Reference *r, const ContactProblem *problem) {
    const int count = r->lu.count;
    for (int i = 0; i < problem->body_count; i++) {
        if (r->nodes[i] < 0) continue;
        const ProblemBody *body = &problem->bodies[i];
        const int k = r->lu.position[r->nodes[i]];
        const double mass = mass_of(body->inv_mass), inverse = (double)body->inv_mass;
        r->bodies[k] = i;
        r->masses[k] = (Vec4){mass, mass, mass_of(body->inv_inertia), 0};
        r->inverses[k] = (Vec4){inverse, inverse, (double)body->inv_inertia, 0};
    }
    r->masses[count] = r->inverses[count] = r->moved[count] = r->changes[count] = (Vec4){0};
    r->first_changes[count] = r->kept[0].moved[count] = r->kept[1].moved[count] = (Vec4){0};
}

/* The row of a direction at a contact point. */
static Vec4 row_of(const ContactPoint *contact, double x, double y) {
    return (Vec4){x, y, (double)contact->arm_b.x * y - (double)contact->arm_b.y * x,
                  (double)contact->arm_a.y * x - (double)contact->arm_a.x * y};
}

static Vec4 relative_velocity(const ProblemBody *a, const ProblemBody *b) {
    return (Vec4){(double)b->velocity.x - (double)a->velocity.x, (double)b->velocity.y - (double)a->velocity.y,
                  (double)b->angular_velocity, (double)a->angular_velocity};
}

static void load_slot(ReferenceGroup *group, int slot, ReferencePair *pair, int k, const ContactProblem *problem) {
    const ContactPoint *contact = &problem->contacts[pair->first + k];
    const double x = (double)contact->normal.x, y = (double)contact->normal.y, friction = (double)contact->friction;
    const Vec4 before = relative_velocity(&problem->bodies[contact->a], &problem->bodies[contact->b]);
    pair->normal[k] = row_of(contact, x, y);
    pair->tangent[k] = row_of(contact, y, -x);
    group->normal_x[slot] = x;
    group->normal_y[slot] = y;
    group->normal_b[slot] = pair->normal[k][2];
    group->normal_a[slot] = pair->normal[k][3];
    group->tangent_b[slot] = pair->tangent[k][2];
    group->tangent_a[slot] = pair->tangent[k][3];
    group->weight[slot] = 1;
    group->mass_normal[slot] = (double)contact->mass_normal;
    group->mass_tangent[slot] = (double)contact->mass_tangent;
    group->inverse_normal[slot] = 1 / (double)contact->mass_normal;
    group->inverse_tangent[slot] = 1 / (double)contact->mass_tangent;
    group->friction[slot] = friction > friction_min ? friction : friction_min;
    group->free_normal[slot] = reference_sum(pair->normal[k] * before) - (double)contact->bias;
    group->free_tangent[slot] = reference_sum(pair->tangent[k] * before);
}

/* A slot that takes part in all operations and has no effect. */
static void clear_group(ReferenceGroup *group) {
    const Vec4 one = {1, 1, 1, 1};
    *group = (ReferenceGroup){.mass_normal = one, .mass_tangent = one, .friction = one, .free_normal = one};
    group->now = (ReferencePoint){.l = one, .u = one, .w = one, .z = one, .p = one, .q = one};
}

static void load_pair(Reference *r, int i, const ContactProblem *problem) {
    ReferencePair *pair = &r->pairs[i];
    const int fixed = r->lu.count, spare = block_lu_spare(&r->lu);
    pair->a = pair->b = fixed;
    pair->place = (BlockPlace){spare, spare};
    if (i >= r->pair_count) return;
    const ContactPoint *contact = &problem->contacts[pair->first];
    const int node_a = r->nodes[contact->a], node_b = r->nodes[contact->b];
    if (node_a < 0 && node_b < 0) return; /* no impulse changes anything */
    if (node_a >= 0) pair->a = r->lu.position[node_a];
    if (node_b >= 0) pair->b = r->lu.position[node_b];
    if (r->edge_of[i] >= 0) pair->place = r->lu.places[r->edge_of[i]];
    r->contact_count += pair->count;
    for (int k = 0; k < pair->count; k++)
        load_slot(&r->groups[i / REFERENCE_PAIRS], i % REFERENCE_PAIRS * 2 + k, pair, k, problem);
}

bool reference_reserve(Reference *r, const ContactProblem *problem) {
    return reserve(r, problem) && analyse(r, problem);
}

bool reference_load(Reference *r, const ContactProblem *problem) {
    if (!reference_reserve(r, problem)) return false;
    load_bodies(r, problem);
    r->contact_count = r->factorizations = r->attempts = 0;
    for (int i = 0; i < r->group_count; i++) clear_group(&r->groups[i]);
    for (int i = 0; i < REFERENCE_PAIRS * r->group_count; i++) load_pair(r, i, problem);
    return true;
}

void reference_start(Reference *r, const ContactProblem *problem, const ContactImpulse *start) {
    for (int i = 0; i < r->pair_count; i++)
        for (int k = 0; k < r->pairs[i].count; k++) {
            const ContactPoint *contact = &problem->contacts[r->pairs[i].first + k];
            const ContactImpulse *given = start != NULL ? &start[r->pairs[i].first + k] : NULL;
            ReferenceGroup *group = &r->groups[i / REFERENCE_PAIRS];
            const int slot = i % REFERENCE_PAIRS * 2 + k;
            group->normal[slot] = (double)(given != NULL ? given->normal : contact->warm_normal);
            group->tangent[slot] = (double)(given != NULL ? given->tangent : contact->warm_tangent);
        }
}

static void store_impulses(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->pair_count; i++)
        for (int k = 0; k < r->pairs[i].count; k++) {
            const ReferenceGroup *group = &r->groups[i / REFERENCE_PAIRS];
            const int slot = i % REFERENCE_PAIRS * 2 + k, contact = r->pairs[i].first + k;
            const double limit = (double)problem->contacts[contact].friction * group->normal[slot];
            const double tangent = group->tangent[slot];
            r->impulses[contact].normal = group->normal[slot];
            r->impulses[contact].tangent = tangent > limit ? limit : tangent < -limit ? -limit : tangent;
        }
}

void reference_store(Reference *r, const ContactProblem *problem) {
    store_impulses(r, problem);
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const Vec4 moved = r->moved[r->nodes[i] >= 0 ? r->lu.position[r->nodes[i]] : r->lu.count];
        r->velocities[i] = (ReferenceVelocity){(double)body->velocity.x + moved[0], (double)body->velocity.y + moved[1],
                                               (double)body->angular_velocity + moved[2]};
    }
}

static const ReferenceKernels *kernels(const Reference *r) {
#ifdef TWINBOX_AVX
    if (!r->scalar && sweeps_can(SWEEP_AVX2)) return &reference_avx2;
#endif
    (void)r;
    return &reference_scalar;
}

/* m/s. Impulses over effective masses reach 6e3 on the way to solutions of piles, walls and pyramids. Where there is no
   solution, they grow without limit, mostly beyond this within ten factorizations. */
static const double jammed = 2e4;

static bool solve_scaled(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, start);
    kernels(r)->run(r);
    reference_store(r, problem);
    return true;
}

bool reference_solve(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    r->aim = REFERENCE_TOLERANCE / 10;
    r->enough = REFERENCE_TOLERANCE / 4;
    r->most = INT_MAX;
    r->jammed = INFINITY;
    if (!solve_scaled(r, problem, start, error)) return false;
    r->residual = kernels(r)->residual(r);
    return true;
}

bool reference_solve_to(Reference *r, const ContactProblem *problem, double tolerance, int most, Error *error) {
    r->aim = r->enough = tolerance;
    r->most = most;
    r->jammed = jammed;
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
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, impulses);
    *residual = kernels(r)->residual(r);
    return true;
}

/* |u - v|^2 with a weight for the spin's square. */
static double squared_distance(const ReferenceVelocity *u, const ReferenceVelocity *v, double spin_weight) {
    double x = u->x - v->x, y = u->y - v->y, spin = u->spin - v->spin;
    return x * x + y * y + spin_weight * (spin * spin);
}

static double larger(double x, double y) { return x > y ? x : y; }

static bool is_right(const ReferenceVelocity *found, const ReferenceVelocity *reference,
                     const ReferenceVelocity *freely) {
    const double least = 0.05 * 0.05, part = 0.05 * 0.05, half_spin = 0.25;
    double allowed = larger(least, part * squared_distance(reference, freely, half_spin));
    return squared_distance(found, reference, half_spin) <= allowed;
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
        error.right += is_right(&found, &reference[i], &freely);
        error.counted++;
    }
    if (error.counted > 0) error.rms = isnan(sum) ? INFINITY : sqrt(sum / error.counted);
    return error;
}

/* The reference (methods/reference.h) as a contact solver, for runs of converged steps. A step that does not
   converge ends with its best answer. */

static void *create(const Settings *chosen, Error *error) {
    (void)chosen;
    Reference *reference = calloc(1, sizeof *reference);
    if (reference == NULL) error_memory(error, "reference");
    return reference;
}

static bool reference_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution,
                                   Error *error) {
    Reference *reference = state;
    if (!reference_solve(reference, problem, NULL, error)) return false;
    reference_round(reference, problem, solution);
    return true;
}

static void destroy(void *state) {
    Reference *reference = state;
    if (reference == NULL) return;
    reference_free(reference);
    free(reference);
}

const ContactSolverKind solver_reference = {
    .description = {.name = "reference",
                    .summary = "the converged solution, by interior points in double; errors are measured against it",
                    .caption = "converged solution",
                    .look = {METHOD_BLACK, METHOD_CIRCLE},
                    .role = METHOD_REFERENCE,
                    .stability_place = 6},
    .create = create,
    .solve = reference_solver_solve,
    .destroy = destroy};
