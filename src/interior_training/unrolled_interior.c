/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/unrolled_interior.h"

#include "interior_training/interior_tape.h"
#include "interior_training/unrolled_iteration.h"
#include "solvers/interior_net.h"
#include "solvers/momentum.h"

#include <math.h>
#include <stddef.h>

void unrolled_interior_free(UnrolledInterior *u) {
    sweeps_free(&u->sweeps);
    interior_free(&u->interior);
    tape_free(&u->tape);
    *u = (UnrolledInterior){0};
}

/* A member of all groups. */
static TapeId member(UnrolledInterior *u, size_t offset) {
    const TapeId id = tape_given(&u->tape, NULL, GROUP_SLOTS * u->interior.group_count);
    for (int i = 0; id >= 0 && i < u->interior.group_count; i++)
        memcpy(tape_values(&u->tape, id) + (ptrdiff_t)GROUP_SLOTS * i, (const char *)&u->interior.groups[i] + offset,
               sizeof(Vec4));
    return id;
}
#define MEMBER(u, name) member(u, offsetof(InteriorGroup, name))

static TapeId bodies(UnrolledInterior *u, const Vec4 *rows) {
    return tape_given(&u->tape, (const double *)rows, 4 * (u->interior.lu.count + 1));
}

static UnrolledNodes begin(UnrolledInterior *u, const double *weights) {
    Tape *t = &u->tape;
    tape_clear(t);
    t->forward = interior_tape_forward;
    t->backward = interior_tape_backward;
    t->context = u;
    u->factor_count = 0;
    u->transposed = -1;
    Interior *s = &u->interior;
    UnrolledNodes n = {.mass_normal = MEMBER(u, mass_normal),
                       .mass_tangent = MEMBER(u, mass_tangent),
                       .inverse_normal = MEMBER(u, inverse_normal),
                       .inverse_tangent = MEMBER(u, inverse_tangent),
                       .friction = MEMBER(u, friction),
                       .bias = MEMBER(u, bias),
                       .masses = bodies(u, s->masses),
                       .inverses = bodies(u, s->inverses),
                       .start = bodies(u, s->start),
                       .one = tape_number(t, 1),
                       .zero = tape_number(t, 0),
                       .l = MEMBER(u, l),
                       .t = MEMBER(u, t),
                       .z = MEMBER(u, z),
                       .p = MEMBER(u, p),
                       .q = MEMBER(u, q),
                       .normal = MEMBER(u, normal),
                       .tangent = MEMBER(u, tangent),
                       .velocities = bodies(u, s->velocities)};
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) n.weights[i] = tape_number(t, weights[i]);
    return n;
}

/* The schedule of interior_iterate(). */
static void next_target(Tape *t, UnrolledNodes *n, int step) {
    TapeId next = tape_scale(t, interior_quick.shrink, n->target);
    if (step > 0) next = tape_larger(t, next, tape_scale(t, interior_quick.follow, tape_square(t, n->estimate)));
    n->target = tape_smaller(t, next, n->target);
}

/* Of the velocities that the answer's impulses make. */
static TapeId error_of(UnrolledInterior *u, const UnrolledNodes *n, TapeId reference, TapeId weights) {
    Tape *t = &u->tape;
    const TapeId push = interior_tape_push(u, n->answer_normal, n->answer_tangent);
    const TapeId by = tape_subtract(t, tape_add(t, n->start, tape_multiply(t, push, n->inverses)), reference);
    return tape_one(t, TAPE_ROOT, tape_one(t, TAPE_SUM, tape_multiply(t, weights, tape_multiply(t, by, by))));
}

static void given_reference(UnrolledInterior *u, const ContactProblem *problem, const ReferenceVelocity *velocities,
                            TapeId *reference, TapeId *weights) {
    const Interior *s = &u->interior;
    int counted = 0;
    for (int i = 0; i < problem->body_count; i++) counted += problem->bodies[i].inv_mass > 0;
    *reference = tape_given(&u->tape, NULL, 4 * (s->lu.count + 1));
    *weights = tape_given(&u->tape, NULL, 4 * (s->lu.count + 1));
    for (int k = 0; !u->tape.failed && k < s->lu.count; k++) {
        const ReferenceVelocity *v = &velocities[s->bodies[k]];
        memcpy(tape_values(&u->tape, *reference) + (ptrdiff_t)4 * k, v, sizeof *v);
        const double weight[3] = {1.0 / counted, 1.0 / counted, 1.0 / (6 * counted)};
        memcpy(tape_values(&u->tape, *weights) + (ptrdiff_t)4 * k, weight, sizeof weight);
    }
}

/* The loss's node; -1 when memory is short. */
static TapeId loss_of(UnrolledInterior *u, UnrolledNodes *n, TapeId reference, TapeId weights,
                      const InteriorTask *task) {
    Tape *t = &u->tape;
    TapeId sum = n->zero;
    for (int step = 0; step < task->last && !t->failed; step++) {
        next_target(t, n, step);
        unrolled_iterate(u, n, step);
        if (t->failed) break;
        const TapeId error = error_of(u, n, reference, weights);
        if (t->failed) break;
        u->errors[step] = tape_values(t, error)[0];
        if (step + 1 < task->first) continue;
        sum = tape_add(t, sum, tape_one(t, TAPE_LOG, tape_add(t, error, tape_number(t, task->floor))));
        sum = tape_add(t, sum, tape_scale(t, task->tail, error));
    }
    return tape_scale(t, 1.0 / (task->last - task->first + 1), sum);
}

static bool load(UnrolledInterior *u, const ContactProblem *problem) {
    float factors[INTERIOR_IMPACT_SWEEPS];
    for (int s = 0; s < INTERIOR_IMPACT_SWEEPS; s++) factors[s] = momentum_factor_tuned(s, INTERIOR_IMPACT_SWEEPS);
    return sweeps_begin_coloured(&u->sweeps, sweeps_best_kernel(), problem) &&
           sweeps_run_momentum(&u->sweeps, factors, INTERIOR_IMPACT_SWEEPS) &&
           interior_load(&u->interior, interior_best(), &u->sweeps, problem);
}

bool unrolled_interior_loss(UnrolledInterior *u, const ContactProblem *problem, const ReferenceVelocity *velocities,
                            const double *weights, const InteriorTask *task, double *loss, double *slopes) {
    *loss = 0;
    u->interior.net = NULL;
    if (!load(u, problem)) return false;
    if (u->interior.contact_count == 0) return true;
    const double first_target = interior_begin(&u->interior, &interior_quick, INTERIOR_IMPACT_SCALE);
    UnrolledNodes n = begin(u, weights);
    TapeId reference, masses;
    given_reference(u, problem, velocities, &reference, &masses);
    n.first_target = n.target = tape_number(&u->tape, first_target);
    n.estimate = tape_number(&u->tape, u->interior.residual);
    const TapeId id = loss_of(u, &n, reference, masses, task);
    if (u->tape.failed) return false;
    *loss = tape_values(&u->tape, id)[0];
    if (slopes == NULL) return true;
    tape_backward(&u->tape, id);
    for (int i = 0; !u->tape.failed && i < INTERIOR_NET_WEIGHTS; i++)
        slopes[i] += tape_slopes(&u->tape, n.weights[i])[0];
    return !u->tape.failed;
}
