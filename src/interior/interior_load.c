/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packs sweeps into groups of contact slots, and numbers the bodies that take part. */
#include "common/array.h"
#include "interior/interior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Friction below this is computed as this: the interval of t must have an inside. The impulses are clamped to the true
   one in the end. */
static const double friction_min = 1e-9;
/* A body that can move but has no inverse mass, in a direction, is this heavy. */
static const double mass_max = 1e20;

void interior_free(Interior *interior) {
    block_lu_free(&interior->lu);
    void *arrays[] = {interior->groups, interior->pairs,    interior->velocities, interior->start,
                      interior->masses, interior->inverses, interior->changes,    interior->bodies,
                      interior->nodes,  interior->edges,    interior->edge_of};
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

static void load_bodies(Interior *s, const Sweeps *sweeps, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        if (s->nodes[i] < 0) continue;
        const ProblemBody *body = &problem->bodies[i];
        const SweepBody *now = &sweeps->bodies[i];
        const int k = s->lu.position[s->nodes[i]];
        const double mass = mass_of(body->inv_mass), inverse = (double)body->inv_mass;
        s->bodies[k] = i;
        s->masses[k] = (Vec4){mass, mass, mass_of(body->inv_inertia), 0};
        s->inverses[k] = (Vec4){inverse, inverse, (double)body->inv_inertia, 0};
        s->start[k] = (Vec4){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity, 0};
        s->velocities[k] = (Vec4){(double)now->x, (double)now->y, (double)now->spin, 0};
    }
    s->changes[s->lu.count] = s->velocities[s->lu.count] = s->start[s->lu.count] = (Vec4){0};
    s->masses[s->lu.count] = s->inverses[s->lu.count] = (Vec4){0};
}

static double dot(Vec4 x, Vec4 y) { return ((x[0] * y[0] + x[1] * y[1]) + x[2] * y[2]) + x[3] * y[3]; }

/* The row of a direction at a contact point. */
static Vec4 row_of(const SweepPoint *point, Vec2 direction) {
    const double x = (double)direction.x, y = (double)direction.y;
    return (Vec4){x, y, (double)point->arm_b.x * y - (double)point->arm_b.y * x,
                  (double)point->arm_a.y * x - (double)point->arm_a.x * y};
}

static double over(float x) { return x != 0 ? 1 / (double)x : 0; }

static void load_slot(InteriorGroup *group, int slot, InteriorPair *rows, int k, const SweepPair *pair, Vec4 now,
                      Vec4 before) {
    const SweepPoint *point = &pair->points[k];
    const Vec4 normal = row_of(point, pair->normal), tangent = row_of(point, vec2_cross_scalar(pair->normal, 1.0f));
    const double friction = (double)pair->friction;
    rows->normal[k] = normal;
    rows->tangent[k] = tangent;
    group->weight[slot] = 1;
    group->mass_normal[slot] = (double)point->mass_normal;
    group->mass_tangent[slot] = (double)point->mass_tangent;
    group->inverse_normal[slot] = over(point->mass_normal);
    group->inverse_tangent[slot] = over(point->mass_tangent);
    group->friction[slot] = friction > friction_min ? friction : friction_min;
    group->bias[slot] = (double)point->bias;
    group->l[slot] = group->answer_normal[slot] = (double)pair->sums[k].normal;
    group->t[slot] = group->answer_tangent[slot] = (double)pair->sums[k].tangent;
    group->normal[slot] = dot(normal, now);
    group->tangent[slot] = dot(tangent, now);
    group->free_normal[slot] = dot(normal, before);
    group->free_tangent[slot] = dot(tangent, before);
}

/* A slot that takes part in all operations and has no effect: l and z are not 0, as they are divisors. */
static void clear_group(InteriorGroup *group) {
    const Vec4 one = {1, 1, 1, 1};
    *group = (InteriorGroup){.friction = one, .l = one, .z = one, .p = one, .q = one, .aim = one};
}

static void load_pair(Interior *s, int i, const Sweeps *sweeps, const ContactProblem *problem) {
    static const InteriorPair none = {0};
    const SweepPair *pair = &sweeps->pairs[i];
    const int a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
    const int node_a = s->nodes[a], node_b = s->nodes[b], fixed = s->lu.count, spare = block_lu_spare(&s->lu);
    InteriorPair *rows = &s->pairs[i];
    *rows = none;
    rows->a = node_a >= 0 ? s->lu.position[node_a] : fixed;
    rows->b = node_b >= 0 ? s->lu.position[node_b] : fixed;
    rows->place = s->edge_of[i] >= 0 ? s->lu.places[s->edge_of[i]] : (BlockPlace){spare, spare};
    if (node_a < 0 && node_b < 0) return; /* no impulse changes anything */
    const SweepBody *now_a = &sweeps->bodies[a], *now_b = &sweeps->bodies[b];
    const ProblemBody *old_a = &problem->bodies[a], *old_b = &problem->bodies[b];
    const Vec4 now = {(double)now_b->x - (double)now_a->x, (double)now_b->y - (double)now_a->y, (double)now_b->spin,
                      (double)now_a->spin};
    const Vec4 before = {(double)old_b->velocity.x - (double)old_a->velocity.x,
                         (double)old_b->velocity.y - (double)old_a->velocity.y, (double)old_b->angular_velocity,
                         (double)old_a->angular_velocity};
    for (int k = 0; k < sweep_pair_points(pair); k++) {
        load_slot(&s->groups[i / GROUP_PAIRS], i % GROUP_PAIRS * 2 + k, rows, k, pair, now, before);
        s->groups[i / GROUP_PAIRS].depth[i % GROUP_PAIRS * 2 + k] =
            -(double)problem->contacts[sweeps->first[i] + k].separation;
        s->contact_count++;
    }
}

bool interior_load(Interior *s, const InteriorKernels *kernels, const Sweeps *sweeps, const ContactProblem *problem) {
    if (!reserve(s, sweeps) || !analyse(s, sweeps, problem)) return false;
    load_bodies(s, sweeps, problem);
    s->group_count = (sweeps->pair_count + GROUP_PAIRS - 1) / GROUP_PAIRS;
    s->contact_count = 0;
    for (int i = 0; i < s->group_count; i++) clear_group(&s->groups[i]);
    for (int i = 0; i < sweeps->pair_count; i++) load_pair(s, i, sweeps, problem);
    if (sweeps->pair_count % GROUP_PAIRS != 0)
        s->pairs[sweeps->pair_count] = (InteriorPair){
            .a = s->lu.count, .b = s->lu.count, .place = {block_lu_spare(&s->lu), block_lu_spare(&s->lu)}};
    s->residual = kernels->residual(s);
    s->iterations = 0;
    return true;
}

double interior_approach(const Interior *s) {
    double sum = 0;
    for (int i = 0; i < s->group_count; i++)
        for (int k = 0; k < GROUP_SLOTS; k++) {
            const double missing = s->groups[i].bias[k] - s->groups[i].free_normal[k];
            if (missing > 0) sum += missing * missing; /* 0 without a contact */
        }
    return s->contact_count > 0 ? sqrt(sum / s->contact_count) : 0;
}

void interior_close(Interior *s, double speed, double depth) {
    for (int i = 0; i < s->group_count; i++)
        for (int k = 0; k < GROUP_SLOTS; k++)
            if (s->groups[i].depth[k] < depth) s->groups[i].bias[k] -= speed;
}
