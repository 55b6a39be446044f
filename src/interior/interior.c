/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior/interior.h"

#include "sweeps/contact_velocity.h"

#include <math.h>

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
