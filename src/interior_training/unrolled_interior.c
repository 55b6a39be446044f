/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/unrolled_interior.h"

#include "interior/interior_constants.h"
#include "interior_training/interior_tape.h"
#include "solvers/interior_net.h"
#include "solvers/momentum.h"

#include <math.h>
#include <stddef.h>

/* The problem and the iterate. */
typedef struct Nodes {
    TapeId mass_normal, mass_tangent, inverse_normal, inverse_tangent, friction, bias;
    TapeId masses, inverses, start, one, zero;
    TapeId weights[INTERIOR_NET_WEIGHTS];
    TapeId l, t, z, p, q, normal, tangent, velocities, answer_normal, answer_tangent;
    TapeId first_target, target, estimate;
} Nodes;

/* Of an iteration. */
typedef struct Linear {
    TapeId over_z, aim_normal, aim_tangent, dn, dt, s, rn, rt, upper, lower, bound;
} Linear;

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

static Nodes begin(UnrolledInterior *u, const double *weights) {
    Tape *t = &u->tape;
    tape_clear(t);
    t->forward = interior_tape_forward;
    t->backward = interior_tape_backward;
    t->context = u;
    u->factor_count = 0;
    u->transposed = -1;
    Interior *s = &u->interior;
    Nodes n = {.mass_normal = MEMBER(u, mass_normal),
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

/* interior_net.h describes them. */
static void inputs_of(Tape *t, const Nodes *n, TapeId inputs[INTERIOR_NET_INPUTS]) {
    const TapeId scale = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->target));
    const TapeId log_l = tape_one(t, TAPE_LOG2, tape_multiply(t, n->l, n->inverse_normal));
    const TapeId log_z = tape_one(t, TAPE_LOG2, n->z);
    const TapeId gap = tape_divide(t, tape_subtract(t, n->normal, n->bias), n->z);
    inputs[0] = tape_scale(t, 0.25, tape_subtract(t, log_l, scale));
    inputs[1] = tape_scale(t, 0.25, tape_subtract(t, log_z, scale));
    inputs[2] = tape_clamp(t, tape_subtract(t, gap, n->one), tape_number(t, INTERIOR_NET_INPUT));
}

/* bias + weights inputs */
static TapeId row(Tape *t, const TapeId *weights, TapeId bias, const TapeId *inputs, int count) {
    TapeId sum = bias;
    for (int i = 0; i < count; i++) sum = tape_add(t, sum, tape_multiply(t, weights[i], inputs[i]));
    return sum;
}

static void globals_of(Tape *t, const Nodes *n, int step, TapeId globals[INTERIOR_NET_GLOBALS]) {
    const TapeId scale = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->target));
    const TapeId first = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->first_target));
    const TapeId residual = tape_one(t, TAPE_LOG2, tape_add(t, n->estimate, tape_number(t, INTERIOR_NET_SMALL)));
    const TapeId gap = tape_number(t, INTERIOR_NET_INPUT);
    globals[0] = n->one;
    globals[1] = tape_number(t, step == 0);
    globals[2] = tape_clamp(t, tape_scale(t, 0.125, tape_subtract(t, scale, first)), gap);
    globals[3] = tape_clamp(t, tape_scale(t, 0.25, tape_subtract(t, residual, scale)), gap);
}

static TapeId bias_of(Tape *t, const TapeId *weights, int stride, const TapeId *globals) {
    TapeId sum = weights[0];
    for (int i = 1; i < INTERIOR_NET_GLOBALS; i++)
        sum = tape_add(t, sum, tape_multiply(t, weights[i * stride], globals[i]));
    return sum;
}

static void evaluate(Tape *t, const Nodes *n, int step, const TapeId *inputs, TapeId *outputs) {
    TapeId globals[INTERIOR_NET_GLOBALS];
    globals_of(t, n, step, globals);
    TapeId hidden[INTERIOR_NET_HIDDEN];
    for (int i = 0; i < INTERIOR_NET_HIDDEN; i++) {
        const TapeId x = row(t, n->weights + INTERIOR_NET_HIDDEN_WEIGHTS + i * INTERIOR_NET_INPUTS,
                             bias_of(t, n->weights + INTERIOR_NET_HIDDEN_BIASES + i, INTERIOR_NET_HIDDEN, globals),
                             inputs, INTERIOR_NET_INPUTS);
        hidden[i] = tape_larger(t, x, tape_scale(t, INTERIOR_NET_LEAK, x));
    }
    for (int i = 0; i < INTERIOR_NET_OUTPUTS; i++) {
        const TapeId x = row(t, n->weights + INTERIOR_NET_OUTPUT_WEIGHTS + i * INTERIOR_NET_HIDDEN,
                             bias_of(t, n->weights + INTERIOR_NET_OUTPUT_BIASES + i, INTERIOR_NET_OUTPUTS, globals),
                             hidden, INTERIOR_NET_HIDDEN);
        outputs[i] = tape_one(t, TAPE_POWER2, tape_clamp(t, x, tape_number(t, INTERIOR_NET_LIMIT)));
    }
}

static void linearise(UnrolledInterior *u, Nodes *n, int step, Linear *by) {
    Tape *t = &u->tape;
    TapeId aim = n->target;
    if (tape_values(t, n->estimate)[0] > INTERIOR_NET_UNTIL) {
        TapeId inputs[INTERIOR_NET_INPUTS], outputs[INTERIOR_NET_OUTPUTS];
        inputs_of(t, n, inputs);
        evaluate(t, n, step, inputs, outputs);
        n->l = tape_multiply(t, n->l, outputs[0]);
        n->t = tape_multiply(t, n->t, outputs[0]);
        n->z = tape_multiply(t, n->z, outputs[1]);
        aim = tape_multiply(t, aim, outputs[2]);
    }
    const TapeId softest = tape_number(t, 1 / stiffest);
    const TapeId bound = by->bound = tape_multiply(t, n->friction, n->l);
    by->over_z = tape_divide(t, n->one, n->z);
    by->aim_normal =
        tape_larger(t, tape_multiply(t, aim, n->mass_normal),
                    tape_multiply(t, tape_multiply(t, softest, tape_multiply(t, n->l, n->l)), n->inverse_normal));
    by->aim_tangent =
        tape_larger(t, tape_multiply(t, tape_scale(t, slip_aim, tape_multiply(t, aim, n->mass_tangent)), n->friction),
                    tape_multiply(t, tape_multiply(t, softest, tape_multiply(t, bound, bound)), n->inverse_tangent));
    by->dn = tape_multiply(t, n->l, by->over_z);
    const TapeId gap = tape_subtract(t, tape_subtract(t, n->normal, n->bias), n->z);
    by->rn = tape_subtract(t, tape_subtract(t, tape_multiply(t, by->aim_normal, by->over_z), n->l),
                           tape_multiply(t, by->dn, gap));
    by->upper = tape_divide(t, n->one, tape_subtract(t, bound, n->t));
    by->lower = tape_divide(t, n->one, tape_add(t, bound, n->t));
    const TapeId p = tape_multiply(t, n->p, by->upper), q = tape_multiply(t, n->q, by->lower);
    by->dt = tape_divide(t, n->one, tape_add(t, p, q));
    by->s = tape_multiply(t, tape_multiply(t, n->friction, tape_subtract(t, p, q)), by->dt);
    const TapeId slip =
        tape_add(t, n->tangent, tape_multiply(t, by->aim_tangent, tape_subtract(t, by->upper, by->lower)));
    by->rt = tape_negative(t, tape_multiply(t, by->dt, slip));
}

typedef struct Changes {
    TapeId l, z, t, p, q, upper, lower;
} Changes;

/* J_n dv and J_t dv of a solve with the impulses l + r_n and t + r_t + s r_n. */
static TapeId solve_changes(UnrolledInterior *u, const Nodes *n, const Linear *by, TapeId factor, TapeId *normal,
                            TapeId *tangent) {
    Tape *t = &u->tape;
    const TapeId impulse_normal = tape_add(t, n->l, by->rn);
    const TapeId impulse_tangent = tape_add(t, tape_add(t, n->t, by->rt), tape_multiply(t, by->s, by->rn));
    const TapeId left = tape_multiply(t, n->masses, tape_subtract(t, n->start, n->velocities));
    const TapeId right = tape_add(t, left, interior_tape_push(u, impulse_normal, impulse_tangent));
    const TapeId x = interior_tape_solve(u, factor, right);
    *normal = interior_tape_normal(u, x);
    *tangent = interior_tape_tangent(u, x);
    return x;
}

/* second_p, second_q: -1 for zero */
static Changes changes_of(Tape *t, const Nodes *n, const Linear *g, TapeId normal, TapeId tangent, TapeId second_p,
                          TapeId second_q) {
    Changes by;
    by.l = tape_subtract(t, g->rn, tape_multiply(t, g->dn, normal));
    by.z = tape_add(t, normal, tape_subtract(t, tape_subtract(t, n->normal, n->bias), n->z));
    by.t = tape_add(t, tape_subtract(t, g->rt, tape_multiply(t, g->dt, tangent)), tape_multiply(t, g->s, by.l));
    const TapeId bound = tape_multiply(t, n->friction, by.l);
    by.upper = tape_subtract(t, bound, by.t);
    by.lower = tape_add(t, bound, by.t);
    const TapeId aim_p = second_p < 0 ? g->aim_tangent : tape_add(t, g->aim_tangent, second_p);
    const TapeId aim_q = second_q < 0 ? g->aim_tangent : tape_add(t, g->aim_tangent, second_q);
    by.p =
        tape_subtract(t, tape_multiply(t, tape_subtract(t, aim_p, tape_multiply(t, n->p, by.upper)), g->upper), n->p);
    by.q =
        tape_subtract(t, tape_multiply(t, tape_subtract(t, aim_q, tape_multiply(t, n->q, by.lower)), g->lower), n->q);
    return by;
}

static void correct(Tape *t, const Nodes *n, Linear *g, TapeId normal, TapeId tangent, TapeId *second_p,
                    TapeId *second_q) {
    const Changes by = changes_of(t, n, g, normal, tangent, -1, -1);
    const TapeId first =
        tape_clamp(t, tape_multiply(t, by.l, by.z), tape_larger(t, g->aim_normal, tape_multiply(t, n->l, n->z)));
    const TapeId over = tape_multiply(t, n->p, tape_subtract(t, g->bound, n->t)),
                 under = tape_multiply(t, n->q, tape_add(t, g->bound, n->t));
    g->rn = tape_subtract(t, g->rn, tape_multiply(t, first, g->over_z));
    *second_p = tape_negative(t, tape_clamp(t, tape_multiply(t, by.p, by.upper), tape_larger(t, g->aim_tangent, over)));
    *second_q =
        tape_negative(t, tape_clamp(t, tape_multiply(t, by.q, by.lower), tape_larger(t, g->aim_tangent, under)));
    g->rt = tape_subtract(
        t, g->rt,
        tape_multiply(t, g->dt,
                      tape_subtract(t, tape_multiply(t, *second_p, g->upper), tape_multiply(t, *second_q, g->lower))));
}

/* The iterate stays inside all bounds. */
static void limit(Tape *t, Nodes *n, const Linear *g, const Changes *by) {
    const TapeId keep = tape_number(t, kept), keep_slip = tape_number(t, kept_slip);
    const TapeId distance = tape_number(t, kept_distance), almost = tape_number(t, 1 - 1e-13);
    const TapeId l = tape_larger(t, tape_add(t, n->l, by->l), tape_multiply(t, keep, n->l));
    const TapeId used = tape_divide(t, tape_magnitude(t, n->t), g->bound);
    const TapeId share = tape_subtract(t, n->one, tape_multiply(t, distance, tape_subtract(t, n->one, used)));
    n->t = tape_clamp(t, tape_add(t, n->t, by->t),
                      tape_multiply(t, tape_smaller(t, share, almost), tape_multiply(t, n->friction, l)));
    n->l = l;
    n->z = tape_larger(t, tape_add(t, n->z, by->z), tape_multiply(t, keep, n->z));
    n->p = tape_larger(t, tape_add(t, n->p, by->p), tape_multiply(t, keep_slip, n->p));
    n->q = tape_larger(t, tape_add(t, n->q, by->q), tape_multiply(t, keep_slip, n->q));
}

static TapeId square(Tape *t, TapeId x) { return tape_multiply(t, x, x); }

/* Of the answer, at the velocities of the full step, and of what the projection into the cones changes. */
static TapeId estimate_of(UnrolledInterior *u, const Nodes *n, TapeId l, TapeId tangential) {
    Tape *t = &u->tape;
    const TapeId normal =
        tape_smaller(t, tape_multiply(t, n->answer_normal, n->inverse_normal), tape_subtract(t, n->normal, n->bias));
    const TapeId bound = tape_multiply(t, n->friction, n->answer_normal);
    const TapeId wanted =
        tape_clamp(t, tape_subtract(t, n->answer_tangent, tape_multiply(t, n->mass_tangent, n->tangent)), bound);
    const TapeId tangent = tape_multiply(t, tape_subtract(t, n->answer_tangent, wanted), n->inverse_tangent);
    const TapeId off_normal = tape_multiply(t, tape_subtract(t, l, n->answer_normal), n->inverse_normal);
    const TapeId off_tangent = tape_multiply(t, tape_subtract(t, tangential, n->answer_tangent), n->inverse_tangent);
    const TapeId squares = tape_add(t, tape_add(t, square(t, normal), square(t, tangent)),
                                    tape_add(t, square(t, off_normal), square(t, off_tangent)));
    return tape_one(t, TAPE_ROOT, tape_scale(t, 1.0 / u->interior.contact_count, tape_one(t, TAPE_SUM, squares)));
}

/* The next iterate, and the answer: the full step, inside the cone. */
static void advance(UnrolledInterior *u, Nodes *n, const Linear *g, TapeId x, TapeId normal, TapeId tangent,
                    const Changes *by) {
    Tape *t = &u->tape;
    const TapeId l = tape_add(t, n->l, by->l), tangential = tape_add(t, n->t, by->t);
    n->answer_normal = tape_larger(t, l, n->zero);
    n->answer_tangent = tape_clamp(t, tangential, tape_multiply(t, n->friction, n->answer_normal));
    limit(t, n, g, by);
    n->velocities = tape_add(t, n->velocities, x);
    n->normal = tape_add(t, n->normal, normal);
    n->tangent = tape_add(t, n->tangent, tangent);
    n->estimate = estimate_of(u, n, l, tangential);
}

static void iterate(UnrolledInterior *u, Nodes *n, int step) {
    Tape *t = &u->tape;
    Linear by;
    linearise(u, n, step, &by);
    const TapeId factor = interior_tape_factor(u, by.dn, by.dt, by.s);
    TapeId normal, tangent, second_p, second_q;
    solve_changes(u, n, &by, factor, &normal, &tangent);
    correct(t, n, &by, normal, tangent, &second_p, &second_q);
    const TapeId x = solve_changes(u, n, &by, factor, &normal, &tangent);
    const Changes changes = changes_of(t, n, &by, normal, tangent, second_p, second_q);
    advance(u, n, &by, x, normal, tangent, &changes);
}

/* The schedule of interior_iterate(). */
static void next_target(Tape *t, Nodes *n, int step) {
    TapeId next = tape_scale(t, interior_at_impacts.shrink, n->target);
    if (step > 0) next = tape_larger(t, next, tape_scale(t, interior_at_impacts.follow, square(t, n->estimate)));
    n->target = tape_smaller(t, next, n->target);
}

/* Of the velocities that the answer's impulses make. */
static TapeId error_of(UnrolledInterior *u, const Nodes *n, TapeId reference, TapeId weights) {
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
static TapeId loss_of(UnrolledInterior *u, Nodes *n, TapeId reference, TapeId weights, const InteriorTask *task) {
    Tape *t = &u->tape;
    TapeId sum = n->zero;
    for (int step = 0; step < task->last && !t->failed; step++) {
        next_target(t, n, step);
        iterate(u, n, step);
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
    const double first_target = interior_begin(&u->interior, &interior_at_impacts, INTERIOR_IMPACT_SCALE);
    Nodes n = begin(u, weights);
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
