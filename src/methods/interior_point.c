/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points (methods/interior_point_internal.h): the iterations, and how sweeps are packed into groups of contact
   slots. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/interior_point_internal.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

/* The scale of velocities at the start is 4 times its residual (with 1 impacts take 0.7 to 1.4 times as long), and no
   less than a millionth of the speed (with 1e-9 or 1e-3 of it, rest takes 0.9 to 1.2 times as long): at rest, one
   iteration from the impulses of the last step mostly suffices. Iterations start inside the bounds: speeds by a share
   of that scale, impulses by what changes the heaviest body's speed by as much. Light bodies may carry it by impulses
   far larger than those that move themselves: from a start by the contacts' own masses it takes hundreds of iterations
   to get there, or they cycle. With a share of 0.05 a struck pyramid of 171 boxes takes three times as long, with 0.3
   impacts have 1.2 times the error. */
static const double scale_of_residual = 4, least_scale = 1e-6, start_share = 0.2;
/* tau^2 at the start, as a share of the squared scale. Each iteration makes it `shrink` of itself, but no less than
   `follow` of the squared residual. With a third or three times the first, impacts have 0.94 of the error in the same
   time; with three times the second, 1.6 times the error; without the third, 3 of 1,100 struck steps end in sweeps. */
static const double first_target = 0.1, shrink = 0.15, follow = 0.05;

const InteriorKernels *interior_best(void) {
#ifdef TWINBOX_AVX
    if (sweeps_can(SWEEP_LANES)) return &interior_avx2;
#endif
    return &interior_scalar;
}

static double larger(double x, double y) { return x > y ? x : y; }

/* Moves the start to the inside of all bounds and returns the first tau^2. */
static double begin(Interior *s, double scale) {
    const double beyond = start_share * scale, impulse = beyond * s->heaviest;
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        for (int k = 0; k < BLOCK_SLOTS; k++) {
            const double l = g->answer_normal[k] + impulse, t = g->answer_tangent[k];
            const double bound = (1 - start_share) * g->friction[k] * l, slip = g->tangent[k];
            g->l[k] = l;
            g->t[k] = t > bound ? bound : t < -bound ? -bound : t;
            g->z[k] = larger(g->normal[k] - g->bias[k], 0) + beyond;
            g->p[k] = larger(-slip, 0) + beyond;
            g->q[k] = larger(slip, 0) + beyond;
        }
    }
    return first_target * scale * scale;
}

static void keep_best(Interior *s) {
    for (int i = 0; i < s->group_count; i++) {
        s->groups[i].best_normal = s->groups[i].answer_normal;
        s->groups[i].best_tangent = s->groups[i].answer_tangent;
    }
}

void interior_iterate(Interior *s, const InteriorKernels *kernels, double speed, double near, int most) {
    if (!(s->residual < speed)) { /* a warm start that is worse than none: a body that held others is gone */
        for (int i = 0; i < s->group_count; i++) s->groups[i].answer_normal = s->groups[i].answer_tangent = (Vec4){0};
        s->residual = kernels->answer(s);
    }
    const double scale = scale_of_residual * s->residual + least_scale * speed;
    double target = begin(s, scale), best = s->residual, estimate = 0;
    bool solved = false;
    keep_best(s);
    for (s->iterations = 0; s->iterations < most && !solved;) {
        const double next = larger(shrink * target, follow * estimate * estimate);
        target = next < target ? next : target;
        estimate = kernels->iterate(s, target);
        s->iterations++;
        if (!isfinite(estimate)) break;
        double residual = estimate;
        if (estimate <= near) {
            residual = s->residual = kernels->answer(s);
            solved = residual <= near;
        }
        if (solved || !(residual < best)) continue;
        best = residual;
        keep_best(s);
    }
    if (!solved) {
        for (int i = 0; i < s->group_count; i++) {
            s->groups[i].answer_normal = s->groups[i].best_normal;
            s->groups[i].answer_tangent = s->groups[i].best_tangent;
        }
        s->residual = kernels->answer(s);
    }
}

bool interior_end(const Interior *s, const Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
    bool finite = true;
    contact_solution_begin(problem, solution);
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (s->pairs[i].a == s->graph.lu.count && s->pairs[i].b == s->graph.lu.count) continue;
        const InteriorGroup *group = &s->groups[i / BLOCK_PAIRS];
        for (int k = 0, slot = i % BLOCK_PAIRS * 2; k < sweep_pair_points(&sweeps->pairs[i]); k++, slot++) {
            const float normal = (float)group->answer_normal[slot], limit = sweeps->pairs[i].friction * normal;
            solution->impulses[sweeps->first[i] + k] = /* rounded into the cone */
                (ContactImpulse){normal, contact_clamp((float)group->answer_tangent[slot], -limit, limit)};
        }
    }
    for (int k = 0; k < s->graph.lu.count; k++) {
        const Vec4 v = s->velocities[k];
        solution->velocities[s->graph.bodies[k]] = (BodyVelocity){vec2((float)v[0], (float)v[1]), (float)v[2]};
        finite &= isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
    }
    return finite;
}

/* Packs sweeps into groups of contact slots. */

/* Friction below this is computed as this: the interval of t must have an inside. The impulses are clamped to the true
   one in the end. */
static const double friction_min = 1e-9;

void interior_free(Interior *interior) {
    block_graph_free(&interior->graph);
    free(interior->memory.memory);
    *interior = (Interior){0};
}

static bool load_graph(Interior *s, const Sweeps *sweeps, const ContactProblem *problem) {
    for (int i = 0; i < sweeps->pair_count; i++)
        s->graph.ends[i] = (BlockEdge){sweep_body_at(sweeps->ends[i].a), sweep_body_at(sweeps->ends[i].b)};
    if (!block_graph_load(&s->graph, problem, sweeps->pair_count)) return false;
    const int count = s->graph.lu.count;
    for (int k = 0; k < count; k++) {
        const ProblemBody *body = &problem->bodies[s->graph.bodies[k]];
        s->start[k] = (Vec4){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity, 0};
    }
    s->changes[count] = s->velocities[count] = s->start[count] = (Vec4){0};
    s->heaviest = 0;
    for (int k = 0; k < count; k++)
        if (s->graph.inverses[k][0] > 0) s->heaviest = larger(s->heaviest, s->graph.masses[k][0]);
    return true;
}

/* Measured on stacks, walls, piles, bins and pyramids of 10 to 1,000 boxes, whose iterations take as long as 5 to 50
   sweeps: nearly the same for each pair, the products of blocks in the factorization, and waiting for memory. */
double interior_work(double products, int pair_count) { return 6 + 0.42 * products / pair_count + pair_count / 400.0; }

static double dot(Vec4 x, Vec4 y) { return ((x[0] * y[0] + x[1] * y[1]) + x[2] * y[2]) + x[3] * y[3]; }

static void load_slot(InteriorGroup *group, int slot, const SweepPair *pair, int k) {
    const SweepPoint *point = &pair->points[k];
    const double friction = (double)pair->friction;
    group->mass_normal[slot] = (double)point->mass_normal;
    group->mass_tangent[slot] = (double)point->mass_tangent;
    group->inverse_normal[slot] = point->mass_normal > 0; /* see interior_load() */
    group->inverse_tangent[slot] = point->mass_tangent > 0;
    group->friction[slot] = friction > friction_min ? friction : friction_min;
    group->bias[slot] = (double)point->bias;
    group->answer_normal[slot] = (double)pair->sums[k].normal;
    group->answer_tangent[slot] = (double)pair->sums[k].tangent;
}

static void load_pair(Interior *s, int i, const Sweeps *sweeps, const ContactProblem *problem) {
    const SweepPair *pair = &sweeps->pairs[i];
    BlockPair *rows = &s->pairs[i];
    InteriorGroup *group = &s->groups[i / BLOCK_PAIRS];
    if (!block_graph_place(&s->graph, i, rows)) return;
    const BlockEdge ends = s->graph.ends[i];
    const Vec4 before = block_pair_velocity(&problem->bodies[ends.a], &problem->bodies[ends.b]);
    for (int k = 0, slot = i % BLOCK_PAIRS * 2; k < sweep_pair_points(pair); k++, slot++) {
        block_rows_load(&group->rows, slot, rows, k, pair->normal, pair->points[k].arm_a, pair->points[k].arm_b);
        load_slot(group, slot, pair, k);
        group->free_normal[slot] = dot(rows->normal[k], before);
        group->free_tangent[slot] = dot(rows->tangent[k], before);
        s->contact_count++;
    }
}

bool interior_load(Interior *s, const InteriorKernels *kernels, const Sweeps *sweeps, const ContactProblem *problem) {
    const size_t bodies = (size_t)sweeps->body_count + 1, groups = (size_t)sweeps->pair_count / BLOCK_PAIRS + 1;
    if (!block_graph_reserve(&s->graph, sweeps->body_count, sweeps->pair_count) ||
        !ARRAY_BLOCK_RESERVE(&s->memory, ARRAY_PART(s->groups, groups), ARRAY_PART(s->pairs, BLOCK_PAIRS * groups),
                             ARRAY_PART(s->velocities, bodies), ARRAY_PART(s->start, bodies),
                             ARRAY_PART(s->changes, bodies), ARRAY_PART(s->corrected, bodies)) ||
        !load_graph(s, sweeps, problem))
        return false;
    const BlockLu *lu = &s->graph.lu;
    const Vec4 zero = {0}, one = {1, 1, 1, 1};
    s->group_count = (sweeps->pair_count + BLOCK_PAIRS - 1) / BLOCK_PAIRS;
    s->contact_count = 0;
    for (int i = 0; i < s->group_count; i++) { /* without contacts: open, at rest, without effect */
        InteriorGroup *g = &s->groups[i];
        g->rows = (BlockRows){zero, zero, zero, zero, zero, zero};
        g->inverse_normal = g->inverse_tangent = zero;
        g->free_normal = g->free_tangent = g->answer_normal = g->answer_tangent = zero;
        g->mass_normal = g->mass_tangent = g->friction = one;
        g->bias = -one;
        s->pairs[BLOCK_PAIRS * i] = s->pairs[BLOCK_PAIRS * i + 1] = (BlockPair){0};
    }
    for (int i = 0; i < sweeps->pair_count; i++) load_pair(s, i, sweeps, problem);
    for (int i = 0; i < s->group_count; i++) { /* the inverses are 1 for a positive mass, else 0 */
        InteriorGroup *g = &s->groups[i];
        g->inverse_normal /= g->mass_normal + (one - g->inverse_normal);
        g->inverse_tangent /= g->mass_tangent + (one - g->inverse_tangent);
    }
    if (sweeps->pair_count % BLOCK_PAIRS != 0) {
        const int32_t none = lu->count, spare = block_lu_spare(lu);
        s->pairs[sweeps->pair_count] = (BlockPair){.a = none, .b = none, .place = {spare, spare}};
    }
    s->residual = kernels->answer(s);
    double products = 0;
    for (int k = 0; k < lu->count; k++) {
        const double below = lu->column[k + 1] - lu->column[k];
        products += below * below;
    }
    s->iteration_work = interior_work(products, sweeps->pair_count);
    s->iterations = 0;
    return true;
}
