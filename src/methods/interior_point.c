/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/interior_point_internal.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tuned on frozen impacts of stacks, towers, gates, pyramids, walls, piles and dominoes of 7 to 45 boxes, for the fewest
   iterations to 0.02 and 0.001 m/s. */
const InteriorRule interior_quick = {
    .impulse = 3, .gap = 0.06, .slip = 0.11, .first = 0.005, .shrink = 0.04, .follow = 0.03};
/* Hand-tuned: where quick iterations break down, and for large pyramids at rest. */
const InteriorRule interior_gentle = {
    .impulse = 0.5, .gap = 0.5, .slip = 0.5, .first = 0.25, .shrink = 0.15, .follow = 0.05};
static const double scale_of_residual = 4;

const InteriorKernels *interior_best(void) {
#ifdef TWINBOX_AVX
    if (sweeps_can(SWEEP_AVX2)) return &interior_avx2;
#endif
    return &interior_scalar;
}

static double larger(double x, double y) { return x > y ? x : y; }

static double scale_of(const Interior *s, double least_scale) { return scale_of_residual * s->residual + least_scale; }

/* Moves the start to the inside of all bounds and returns the first tau^2. */
static double begin(Interior *s, const InteriorRule *rule, double least_scale) {
    const double scale = scale_of(s, least_scale);
    const double impulse = rule->impulse * scale, gap = rule->gap * scale, beyond = rule->slip * scale;
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        for (int k = 0; k < GROUP_SLOTS; k++) {
            const double l = g->answer_normal[k] + impulse * g->mass_normal[k], t = g->answer_tangent[k];
            const double bound = 0.9 * g->friction[k] * l, slip = g->tangent[k];
            g->l[k] = l;
            g->t[k] = t > bound ? bound : t < -bound ? -bound : t;
            g->z[k] = larger(g->normal[k] - g->bias[k], 0) + gap;
            g->p[k] = larger(-slip, 0) + beyond;
            g->q[k] = larger(slip, 0) + beyond;
        }
    }
    return rule->first * scale * scale;
}

static bool is_jammed(const Interior *s) {
    const double largest = interior_impulse_max;
    bool jammed = false;
    for (int i = 0; i < s->group_count; i++) {
        const Vec4 speed = s->groups[i].answer_normal * s->groups[i].inverse_normal;
        jammed |= (speed[0] > largest) | (speed[1] > largest) | (speed[2] > largest) | (speed[3] > largest);
    }
    return jammed;
}

void interior_iterate(Interior *s, const InteriorKernels *kernels, const InteriorRule *rule, double least_scale,
                      double lost, double near, int most) {
    const double too_large = lost * (scale_of(s, least_scale) + 0.1);
    double target = begin(s, rule, least_scale), estimate = 0;
    for (s->iterations = 0; s->iterations < most;) {
        const double next = larger(rule->shrink * target, rule->follow * estimate * estimate);
        target = next < target ? next : target;
        s->residual = estimate = kernels->iterate(s, target);
        s->iterations++;
        if (!(estimate < too_large)) break;
        if (estimate > near && s->iterations < most) continue;
        s->residual = kernels->answer(s);
        if (is_jammed(s)) s->residual = INFINITY;
        if (!(s->residual > near)) return;
    }
    if (!(estimate < too_large)) s->residual = INFINITY;
}

static bool store_bodies(const Interior *s, const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        solution->velocities[i] = (BodyVelocity){body->velocity, body->angular_velocity};
    }
    bool finite = true;
    for (int k = 0; k < s->lu.count; k++) {
        const Vec4 v = s->velocities[k];
        solution->velocities[s->bodies[k]] = (BodyVelocity){vec2((float)v[0], (float)v[1]), (float)v[2]};
        finite &= isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
    }
    return finite;
}

/* Rounded into the cone. */
static ContactImpulse impulse_of(const InteriorGroup *group, int slot, float friction) {
    const float normal = (float)group->answer_normal[slot], limit = friction * normal;
    return (ContactImpulse){normal, contact_clamp((float)group->answer_tangent[slot], -limit, limit)};
}

bool interior_end(const Interior *s, const Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const InteriorGroup *group = &s->groups[i / GROUP_PAIRS];
        const bool moves = interior_pair_moves(s, &s->pairs[i]);
        for (int k = 0; k < sweep_pair_points(pair); k++)
            solution->impulses[sweeps->first[i] + k] =
                moves ? impulse_of(group, i % GROUP_PAIRS * 2 + k, pair->friction) : (ContactImpulse){0};
    }
    return store_bodies(s, problem, solution);
}

/* Packs sweeps into groups of contact slots, and numbers the bodies that take part. */

/* Friction below this is computed as this: the interval of t must have an inside. The impulses are clamped to the true
   one in the end. */
static const double friction_min = 1e-9;
/* A body that can move but has no inverse mass, in a direction, is this heavy. */
static const double mass_max = 1e20;

void interior_free(Interior *interior) {
    block_lu_free(&interior->lu);
    void *arrays[] = {interior->groups, interior->pairs,    interior->velocities, interior->start,
                      interior->masses, interior->inverses, interior->changes,    interior->corrected,
                      interior->bodies, interior->nodes,    interior->edges,      interior->edge_of};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *interior = (Interior){0};
}

static bool reserve(Interior *s, const Sweeps *sweeps) {
    const size_t bodies = (size_t)sweeps->body_count + 1, pairs = (size_t)sweeps->pair_count + 1;
    const size_t row = sizeof(Vec4);
    return array_reserve((void **)&s->groups, &s->group_capacity, pairs / GROUP_PAIRS + 1, sizeof *s->groups) &&
           array_reserve((void **)&s->pairs, &s->pair_capacity, pairs + 1, sizeof *s->pairs) &&
           array_reserve((void **)&s->edges, &s->edge_capacity, pairs, sizeof *s->edges) &&
           array_reserve((void **)&s->edge_of, &s->edge_of_capacity, pairs, sizeof *s->edge_of) &&
           array_reserve((void **)&s->velocities, &s->velocity_capacity, bodies, row) &&
           array_reserve((void **)&s->start, &s->start_capacity, bodies, row) &&
           array_reserve((void **)&s->masses, &s->mass_capacity, bodies, row) &&
           array_reserve((void **)&s->inverses, &s->inverse_capacity, bodies, row) &&
           array_reserve((void **)&s->changes, &s->change_capacity, bodies, row) &&
           array_reserve((void **)&s->corrected, &s->corrected_capacity, bodies, row) &&
           array_reserve((void **)&s->bodies, &s->body_capacity, bodies, sizeof *s->bodies) &&
           array_reserve((void **)&s->nodes, &s->node_capacity, bodies, sizeof *s->nodes);
}

/* Nodes are the moving bodies that touch something, in the order of the bodies. Returns their number. */
static int number_bodies(Interior *s, const Sweeps *sweeps, const ContactProblem *problem) {
    memset(s->nodes, 0, (size_t)problem->body_count * sizeof *s->nodes);
    for (int i = 0; i < sweeps->pair_count; i++) {
        s->nodes[sweep_body_at(sweeps->ends[i].a)] = 1;
        s->nodes[sweep_body_at(sweeps->ends[i].b)] = 1;
    }
    int count = 0;
    for (int i = 0; i < problem->body_count; i++)
        s->nodes[i] = s->nodes[i] && problem_body_moves(&problem->bodies[i]) ? count++ : -1;
    return count;
}

static bool analyse(Interior *s, const Sweeps *sweeps, const ContactProblem *problem) {
    const int count = number_bodies(s, sweeps, problem);
    int edges = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int a = s->nodes[sweep_body_at(sweeps->ends[i].a)], b = s->nodes[sweep_body_at(sweeps->ends[i].b)];
        s->edge_of[i] = a >= 0 && b >= 0 ? edges : -1;
        if (s->edge_of[i] >= 0) s->edges[edges++] = (BlockEdge){a, b};
    }
    return block_lu_analyse(&s->lu, count, s->edges, edges);
}

static double mass_of(float inverse) { return inverse > 0 ? 1 / (double)inverse : mass_max; }

static void load_bodies(Interior *s, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        if (s->nodes[i] < 0) continue;
        const ProblemBody *body = &problem->bodies[i];
        const int k = s->lu.position[s->nodes[i]];
        const double mass = mass_of(body->inv_mass), inverse = (double)body->inv_mass;
        s->bodies[k] = i;
        s->masses[k] = (Vec4){mass, mass, mass_of(body->inv_inertia), 0};
        s->inverses[k] = (Vec4){inverse, inverse, (double)body->inv_inertia, 0};
        s->start[k] = (Vec4){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity, 0};
    }
    s->changes[s->lu.count] = s->velocities[s->lu.count] = s->start[s->lu.count] = (Vec4){0};
    s->masses[s->lu.count] = s->inverses[s->lu.count] = (Vec4){0};
}

/* The rows of a contact. */
static void load_rows(InteriorGroup *group, int slot, InteriorPair *rows, int k, Vec2 normal, const SweepPoint *point) {
    const double x = (double)normal.x, y = (double)normal.y;
    const double bx = (double)point->arm_b.x, by = (double)point->arm_b.y;
    const double ax = (double)point->arm_a.x, ay = (double)point->arm_a.y;
    const Vec4 along = {x, y, bx * y - by * x, ay * x - ax * y}, across = {y, -x, -(bx * x + by * y), ax * x + ay * y};
    rows->normal[k] = along;
    rows->tangent[k] = across;
    group->normal_x[slot] = x;
    group->normal_y[slot] = y;
    group->normal_b[slot] = along[2];
    group->normal_a[slot] = along[3];
    group->tangent_b[slot] = across[2];
    group->tangent_a[slot] = across[3];
}

static double dot(Vec4 x, Vec4 y) { return ((x[0] * y[0] + x[1] * y[1]) + x[2] * y[2]) + x[3] * y[3]; }

static void load_slot(InteriorGroup *group, int slot, const SweepPair *pair, int k) {
    const SweepPoint *point = &pair->points[k];
    const double friction = (double)pair->friction;
    group->mass_normal[slot] = (double)point->mass_normal;
    group->mass_tangent[slot] = (double)point->mass_tangent;
    group->inverse_normal[slot] = point->mass_normal > 0; /* see invert() */
    group->inverse_tangent[slot] = point->mass_tangent > 0;
    group->friction[slot] = friction > friction_min ? friction : friction_min;
    group->bias[slot] = (double)point->bias;
    group->answer_normal[slot] = (double)pair->sums[k].normal;
    group->answer_tangent[slot] = (double)pair->sums[k].tangent;
}

/* Velocity of b minus that of a, spins of b and a, before any impulse. */
static Vec4 velocities_before(const ProblemBody *a, const ProblemBody *b) {
    return (Vec4){(double)b->velocity.x - (double)a->velocity.x, (double)b->velocity.y - (double)a->velocity.y,
                  (double)b->angular_velocity, (double)a->angular_velocity};
}

static void load_pair(Interior *s, int i, const Sweeps *sweeps, const ContactProblem *problem) {
    const SweepPair *pair = &sweeps->pairs[i];
    const int a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b), first = sweeps->first[i];
    const int node_a = s->nodes[a], node_b = s->nodes[b], fixed = s->lu.count, spare = block_lu_spare(&s->lu);
    InteriorPair *rows = &s->pairs[i];
    InteriorGroup *group = &s->groups[i / GROUP_PAIRS];
    rows->a = node_a >= 0 ? s->lu.position[node_a] : fixed;
    rows->b = node_b >= 0 ? s->lu.position[node_b] : fixed;
    rows->place = s->edge_of[i] >= 0 ? s->lu.places[s->edge_of[i]] : (BlockPlace){spare, spare};
    if (!interior_pair_moves(s, rows)) return;
    const Vec4 before = velocities_before(&problem->bodies[a], &problem->bodies[b]);
    for (int k = 0, slot = i % GROUP_PAIRS * 2; k < sweep_pair_points(pair); k++, slot++) {
        load_rows(group, slot, rows, k, pair->normal, &pair->points[k]);
        load_slot(group, slot, pair, k);
        group->depth[slot] = -(double)problem->contacts[first + k].separation;
        group->free_normal[slot] = dot(rows->normal[k], before);
        group->free_tangent[slot] = dot(rows->tangent[k], before);
        s->contact_count++;
    }
}

/* Without contacts: open, at rest, without effect. */
static void clear_slots(Interior *s, int i) {
    const Vec4 zero = {0}, one = {1, 1, 1, 1};
    static const InteriorPair none = {0};
    InteriorGroup *g = &s->groups[i];
    g->normal_x = g->normal_y = g->normal_b = g->normal_a = g->tangent_b = g->tangent_a = zero;
    g->inverse_normal = g->inverse_tangent = g->depth = zero;
    g->free_normal = g->free_tangent = g->answer_normal = g->answer_tangent = zero;
    g->mass_normal = g->mass_tangent = g->friction = one;
    g->bias = -one;
    s->pairs[GROUP_PAIRS * i] = s->pairs[GROUP_PAIRS * i + 1] = none;
}

/* The inverses were 1 for a positive mass, else 0. */
static void invert(InteriorGroup *g) {
    const Vec4 one = {1, 1, 1, 1};
    g->inverse_normal /= g->mass_normal + (one - g->inverse_normal);
    g->inverse_tangent /= g->mass_tangent + (one - g->inverse_tangent);
}

bool interior_load(Interior *s, const InteriorKernels *kernels, const Sweeps *sweeps, const ContactProblem *problem) {
    if (!reserve(s, sweeps) || !analyse(s, sweeps, problem)) return false;
    load_bodies(s, problem);
    s->group_count = (sweeps->pair_count + GROUP_PAIRS - 1) / GROUP_PAIRS;
    s->contact_count = 0;
    for (int i = 0; i < s->group_count; i++) clear_slots(s, i);
    for (int i = 0; i < sweeps->pair_count; i++) load_pair(s, i, sweeps, problem);
    for (int i = 0; i < s->group_count; i++) invert(&s->groups[i]);
    if (sweeps->pair_count % GROUP_PAIRS != 0) {
        const int spare = block_lu_spare(&s->lu);
        s->pairs[sweeps->pair_count].a = s->pairs[sweeps->pair_count].b = s->lu.count;
        s->pairs[sweeps->pair_count].place = (BlockPlace){spare, spare};
    }
    s->residual = kernels->answer(s);
    s->iterations = 0;
    return true;
}

void interior_close(Interior *s, double speed, double depth) {
    for (int i = 0; i < s->group_count; i++)
        for (int k = 0; k < GROUP_SLOTS; k++)
            if (s->groups[i].depth[k] < depth) s->groups[i].bias[k] -= speed;
}
