/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior/interior.h"

#include "sweeps/contact_velocity.h"

#include <math.h>

/* Hand-tuned, for the fewest iterations at impacts of the stack and the pyramids. The scale of velocities is 4 times the
   residual at the start plus `calm` (m/s); impulses and slips start at half of it beyond their values, and tau^2 at
   `first` times its square. tau^2 falls to `shrink` of itself, or to `follow` times the squared residual. */
static const double scale_of_residual = 4, calm = 0.01, inside = 0.5, first = 0.25;
const double interior_shrink = 0.15, interior_follow = 0.05;

const InteriorKernels *interior_best(void) {
#ifdef TWINBOX_AVX
    if (sweeps_can(SWEEP_AVX2)) return &interior_avx2;
#endif
    return &interior_scalar;
}

static double larger(double x, double y) { return x > y ? x : y; }

double interior_begin(Interior *s) {
    const double scale = scale_of_residual * s->residual + calm, off = inside * scale;
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        for (int k = 0; k < GROUP_SLOTS; k++) {
            if (!(g->weight[k] > 0)) continue;
            g->l[k] += off * g->mass_normal[k];
            const double bound = 0.9 * g->friction[k] * g->l[k], slip = g->tangent[k];
            g->t[k] = g->t[k] > bound ? bound : g->t[k] < -bound ? -bound : g->t[k];
            g->z[k] = larger(g->normal[k] - g->bias[k], 0) + off;
            g->p[k] = larger(-slip, 0) + off;
            g->q[k] = larger(slip, 0) + off;
        }
    }
    return first * scale * scale;
}

void interior_iterate(Interior *s, const InteriorKernels *kernels, double near, int most) {
    double target = interior_begin(s);
    for (s->iterations = 0; s->iterations < most;) {
        const double least = s->iterations > 0 ? interior_follow * s->residual * s->residual : 0;
        const double next = larger(interior_shrink * target, least);
        target = next < target ? next : target;
        s->residual = kernels->iterate(s, target);
        s->iterations++;
        if (!isfinite(s->residual) || s->residual <= near) return;
    }
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
    if (!(group->weight[slot] > 0)) return (ContactImpulse){0};
    const float normal = (float)group->answer_normal[slot], limit = friction * normal;
    return (ContactImpulse){normal, contact_clamp((float)group->answer_tangent[slot], -limit, limit)};
}

bool interior_end(const Interior *s, const Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        for (int k = 0; k < sweep_pair_points(pair); k++)
            solution->impulses[sweeps->first[i] + k] =
                impulse_of(&s->groups[i / GROUP_PAIRS], i % GROUP_PAIRS * 2 + k, pair->friction);
    }
    return store_bodies(s, problem, solution);
}
