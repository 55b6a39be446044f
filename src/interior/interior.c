/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior/interior.h"

#include "sweeps/contact_velocity.h"

#include <math.h>

/* Hand-tuned, for the fewest iterations at impacts of the stack and the pyramids. The scale of velocities is 4 times the
   residual at the start plus `calm` (m/s); impulses and slips start at half of it beyond their values, and tau^2 at
   `first` times its square. tau^2 falls to `shrink` of itself, or to `follow` times the squared residual. */
static const double scale_of_residual = 4, calm = 0.01, inside = 0.5, first = 0.25;
const double interior_shrink = 0.15, interior_follow = 0.05;
/* Iterations have broken down, as in a problem without a solution, if the residual is this multiple of the scale. */
static const double lost = 1e6;

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
            const double l = g->answer_normal[k] + off * g->mass_normal[k], t = g->answer_tangent[k];
            const double bound = 0.9 * g->friction[k] * l, slip = g->tangent[k];
            g->l[k] = l;
            g->t[k] = t > bound ? bound : t < -bound ? -bound : t;
            g->z[k] = larger(g->normal[k] - g->bias[k], 0) + off;
            g->p[k] = larger(-slip, 0) + off;
            g->q[k] = larger(slip, 0) + off;
        }
    }
    return s->first_target = first * scale * scale;
}

void interior_iterate(Interior *s, const InteriorKernels *kernels, double near, int most) {
    double target = interior_begin(s), estimate = 0;
    const double scale = sqrt(target / first);
    for (s->iterations = 0; s->iterations < most;) {
        const double next = larger(interior_shrink * target, interior_follow * estimate * estimate);
        target = next < target ? next : target;
        s->residual = estimate = kernels->iterate(s, target);
        s->iterations++;
        if (!(estimate < lost * scale)) break;
        if (estimate > near && s->iterations < most) continue;
        s->residual = kernels->answer(s);
        if (!(s->residual > near)) return;
    }
    if (!(estimate < lost * scale)) s->residual = INFINITY;
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
