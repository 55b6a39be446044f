/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packs a contact problem into records of bodies, and of pairs in the order of visits. */
#include "common/array.h"
#include "sweeps/contact_velocity.h"
#include "sweeps/sweeps_kernels.h"

#include <math.h>

static bool reserve(Sweeps *sweeps, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, pairs = (size_t)problem->contact_count + 1;
    if (2 * bodies <= sweeps->body_capacity && bodies <= sweeps->ready_capacity && pairs <= sweeps->scheduled_capacity)
        return true;
    return array_reserve((void **)&sweeps->bodies, &sweeps->body_capacity, 2 * bodies, sizeof *sweeps->bodies) &&
           array_reserve((void **)&sweeps->moves, &sweeps->moves_capacity, bodies, sizeof *sweeps->moves) &&
           array_reserve((void **)&sweeps->ready, &sweeps->ready_capacity, bodies, sizeof *sweeps->ready) &&
           array_reserve((void **)&sweeps->first, &sweeps->first_capacity, pairs, sizeof *sweeps->first) &&
           array_reserve((void **)&sweeps->pairs, &sweeps->pair_capacity, pairs, sizeof *sweeps->pairs) &&
           array_reserve((void **)&sweeps->quiet_since, &sweeps->quiet_capacity, pairs, sizeof *sweeps->quiet_since) &&
           array_reserve((void **)&sweeps->changed_at, &sweeps->changed_capacity, bodies, sizeof *sweeps->changed_at) &&
           array_reserve((void **)&sweeps->ends, &sweeps->ends_capacity, pairs, sizeof *sweeps->ends) &&
           array_reserve((void **)&sweeps->scheduled, &sweeps->scheduled_capacity, pairs, sizeof *sweeps->scheduled);
}

static bool is_negative_zero(float x) { return x == 0.0f && signbit(x); }

/* True if an impulse can change the velocity. For a static body only if it is -0, which may become 0. */
static bool moves(const ProblemBody *body) {
    return problem_body_moves(body) || is_negative_zero(body->velocity.x) || is_negative_zero(body->velocity.y) ||
           is_negative_zero(body->angular_velocity);
}

static void load_bodies(Sweeps *sweeps, const ContactProblem *problem) {
    sweeps->body_count = problem->body_count;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        sweeps->bodies[i] = (SweepBody){body->velocity.x, body->velocity.y, body->angular_velocity, body->inv_mass};
        sweeps->moves[i] = moves(body);
    }
    sweeps->bodies[problem->body_count] = (SweepBody){0};
}

/* If neither moves, a counts as moving: visits of one pair must not share a level. */
static SweepEnds ends_of(const Sweeps *sweeps, int a, int b) {
    bool moves_a = sweeps->moves[a] || !sweeps->moves[b];
    return (SweepEnds){moves_a ? a : ~a, sweeps->moves[b] ? b : ~b};
}

/* Member by member, so that a record is written once and not copied. */
static void load_point(SweepPair *pair, int k, const ContactPoint *contact, float extra, bool warm, float relaxation) {
    SweepPoint *point = &pair->points[k];
    pair->sums[k].normal = warm ? contact->warm_normal : 0.0f;
    pair->sums[k].tangent = warm ? contact->warm_tangent : 0.0f;
    point->arm_a = contact->arm_a;
    point->arm_b = contact->arm_b;
    point->mass_normal = relaxation * contact->mass_normal;
    point->mass_tangent = relaxation * contact->mass_tangent;
    point->bias = contact->bias;
    point->extra = extra;
}

/* Packs the pair that begins with contact `first` of the problem; returns its number of points. */
static int load_pair(Sweeps *sweeps, const ContactProblem *problem, int first, bool warm, float relaxation) {
    static const ContactPoint none = {0};
    const ContactPoint *contact = &problem->contacts[first], *next = contact + 1;
    const int points = contact_surface_points(problem, first);
    SweepPair *pair = &sweeps->pairs[sweeps->pair_count];
    pair->normal = contact->normal;
    pair->friction = contact->friction;
    pair->inv_inertia_a = problem->bodies[contact->a].inv_inertia;
    load_point(pair, 0, contact, problem->bodies[contact->b].inv_inertia, warm, relaxation);
    load_point(pair, 1, points == 2 ? next : &none, points == 2 ? -1.0f : 0.0f, warm, relaxation);
    sweeps->first[sweeps->pair_count] = first;
    sweeps->ends[sweeps->pair_count++] = ends_of(sweeps, contact->a, contact->b);
    return points;
}

/* visits: the order of contacts, with those of a pair adjacent; NULL for the problem's order. */
static void load_pairs(Sweeps *sweeps, const ContactProblem *problem, const int32_t *visits, bool warm,
                       float relaxation) {
    sweeps->pair_count = 0;
    for (int i = 0; i < problem->contact_count;)
        i += load_pair(sweeps, problem, visits != NULL ? visits[i] : i, warm, relaxation);
    sweeps->pairs[sweeps->pair_count] = (SweepPair){0};
}

static bool begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, const int32_t *visits, bool warm,
                  float relaxation) {
    if (!reserve(sweeps, problem)) return false;
    sweeps->kernel = kernel;
    sweeps->coloured = visits != NULL;
    load_bodies(sweeps, problem);
    load_pairs(sweeps, problem, visits, warm, relaxation);
    sweeps_warm_start(sweeps);
    return true;
}

bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm, float relaxation) {
    return begin(sweeps, kernel, problem, NULL, warm, relaxation);
}

bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem) {
    return colours_order(&sweeps->colours, problem) &&
           begin(sweeps, kernel, problem, sweeps->colours.visits, true, 1.0f);
}

bool sweeps_begin_blocks(Sweeps *sweeps, const ContactProblem *problem) {
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    for (int i = 0; i < sweeps->pair_count; i++) {
        SweepPair *pair = &sweeps->pairs[i];
        const ContactPoint *contact = &problem->contacts[sweeps->first[i]];
        pair->block = sweep_pair_points(pair) == 2 ? block_make(contact, contact + 1, problem->bodies) : (Block){0};
    }
    return true;
}
