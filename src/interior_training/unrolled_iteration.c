/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/unrolled_iteration.h"

#include "interior/interior_constants.h"
#include "interior_training/interior_tape.h"

/* Of an iteration. */
typedef struct Linear {
    TapeId over_z, aim_normal, aim_tangent, dn, dt, s, rn, rt, upper, lower, bound;
} Linear;

static void linearise(UnrolledInterior *u, UnrolledNodes *n, int step, Linear *by) {
    Tape *t = &u->tape;
    TapeId aim = n->target;
    if (tape_values(t, n->estimate)[0] > INTERIOR_NET_UNTIL) {
        TapeId outputs[INTERIOR_NET_OUTPUTS];
        unrolled_network(t, n, step, outputs);
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
static TapeId solve_changes(UnrolledInterior *u, const UnrolledNodes *n, const Linear *by, TapeId factor,
                            TapeId *normal, TapeId *tangent) {
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
static Changes changes_of(Tape *t, const UnrolledNodes *n, const Linear *g, TapeId normal, TapeId tangent,
                          TapeId second_p, TapeId second_q) {
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

static void correct(Tape *t, const UnrolledNodes *n, Linear *g, TapeId normal, TapeId tangent, TapeId *second_p,
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
static void limit(Tape *t, UnrolledNodes *n, const Linear *g, const Changes *by) {
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

/* Of the answer, at the velocities of the full step, and of what the projection into the cones changes. */
static TapeId estimate_of(UnrolledInterior *u, const UnrolledNodes *n, TapeId l, TapeId tangential) {
    Tape *t = &u->tape;
    const TapeId normal =
        tape_smaller(t, tape_multiply(t, n->answer_normal, n->inverse_normal), tape_subtract(t, n->normal, n->bias));
    const TapeId bound = tape_multiply(t, n->friction, n->answer_normal);
    const TapeId wanted =
        tape_clamp(t, tape_subtract(t, n->answer_tangent, tape_multiply(t, n->mass_tangent, n->tangent)), bound);
    const TapeId tangent = tape_multiply(t, tape_subtract(t, n->answer_tangent, wanted), n->inverse_tangent);
    const TapeId off_normal = tape_multiply(t, tape_subtract(t, l, n->answer_normal), n->inverse_normal);
    const TapeId off_tangent = tape_multiply(t, tape_subtract(t, tangential, n->answer_tangent), n->inverse_tangent);
    const TapeId squares = tape_add(t, tape_add(t, tape_square(t, normal), tape_square(t, tangent)),
                                    tape_add(t, tape_square(t, off_normal), tape_square(t, off_tangent)));
    return tape_one(t, TAPE_ROOT, tape_scale(t, 1.0 / u->interior.contact_count, tape_one(t, TAPE_SUM, squares)));
}

/* The next iterate, and the answer: the full step, inside the cone. */
static void advance(UnrolledInterior *u, UnrolledNodes *n, const Linear *g, TapeId x, TapeId normal, TapeId tangent,
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

void unrolled_iterate(UnrolledInterior *u, UnrolledNodes *n, int step) {
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
