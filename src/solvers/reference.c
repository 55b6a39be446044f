/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: nonsmooth nonlinear conjugate gradients over sweeps of projected Gauss-Seidel.

   A sweep over all contacts (the map of sequential impulses, in double) turns impulses p into p'. Its step is taken
   as a steepest descent, and the steps are made conjugate as Fletcher and Reeves do:

       g = p - p',  beta = |g|^2 / |g of the sweep before|^2,  d' = beta d - g,  p = p' + beta d.

   Velocities are linear in the impulses: theirs is the same recursion. Source: Silcowitz, Niebuhr, Poulsen, Erleben,
   "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force Problems" (2010). They begin anew
   (d' = -g, p = p') where beta > 1. Here that is done where a step turns against d, and beta is at most 1: contacts
   that share a load in more than one way drift at constant speed, beta = 1, until one slips or parts, and the
   published rule stops every second step of that (O'Donoghue, Candes, "Adaptive Restart for Accelerated Gradient
   Schemes", 2015). A third to a tenth of the sweeps for the same error.

   Fails slowly where such a drift is long; the residual says so. */
#include "solvers/reference_units.h"

#include <math.h>
#include <string.h>

static double relative_velocity(const ReferenceVelocity *a, const ReferenceVelocity *b, const ReferenceRow *row) {
    return (row->a[0] * a->x + row->a[1] * a->y + row->a[2] * a->spin) +
           (row->b[0] * b->x + row->b[1] * b->y + row->b[2] * b->spin);
}

static void apply(ReferenceVelocity *a, ReferenceVelocity *b, const ReferenceRow *row, double impulse) {
    a->x += row->a[0] * impulse;
    a->y += row->a[1] * impulse;
    a->spin += row->a[2] * impulse;
    b->x += row->b[0] * impulse;
    b->y += row->b[1] * impulse;
    b->spin += row->b[2] * impulse;
}

/* One contact, once. Returns by how much its two impulses change. */
static ReferenceImpulse solve_contact(const ReferenceContact *contact, ReferenceVelocity *momenta,
                                      ReferenceImpulse *sum) {
    ReferenceVelocity a = momenta[contact->a], b = momenta[contact->b];
    ReferenceImpulse before = *sum, step;
    double total = before.normal + (contact->normal.target - relative_velocity(&a, &b, &contact->normal));
    sum->normal = total > 0 ? total : 0;
    step.normal = sum->normal - before.normal;
    apply(&a, &b, &contact->normal, step.normal);

    double limit = contact->friction * sum->normal;
    total = before.tangent + (contact->tangent.target - relative_velocity(&a, &b, &contact->tangent));
    total = total < limit ? total : limit;
    sum->tangent = total > -limit ? total : -limit;
    step.tangent = sum->tangent - before.tangent;
    apply(&a, &b, &contact->tangent, step.tangent);
    momenta[contact->a] = a;
    momenta[contact->b] = b;
    return step;
}

static double larger(double x, double y) { return x > y ? x : y; }

/* What one sweep did: |g|^2; -g d, with the direction of the sweeps before; and the largest change of a contact's
   relative velocity, m/s. The first two are energies: bodies of unlike mass count alike. */
typedef struct Sweep {
    double squared, along, change;
} Sweep;

static Sweep sweep(Reference *r) {
    memcpy(r->momenta_before, r->momenta, (size_t)r->body_count * sizeof *r->momenta);
    memcpy(r->sums_before, r->sums, (size_t)r->contact_count * sizeof *r->sums);
    ReferenceImpulse squared = {0, 0}, along = {0, 0}, change = {0, 0};
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        ReferenceImpulse step = solve_contact(contact, r->momenta, &r->sums[i]);
        squared.normal += step.normal * step.normal;
        squared.tangent += step.tangent * step.tangent;
        along.normal += step.normal * r->direction[i].normal;
        along.tangent += step.tangent * r->direction[i].tangent;
        change.normal = larger(fabs(step.normal) / contact->normal.scale, change.normal);
        change.tangent = larger(fabs(step.tangent) / contact->tangent.scale, change.tangent);
    }
    r->sweeps++;
    return (Sweep){squared.normal + squared.tangent, along.normal + along.tangent,
                   larger(change.normal, change.tangent)};
}

/* p = p' + beta d and d' = beta d - g for a row of numbers. */
static void extrapolate_numbers(double *values, const double *before, double *direction, int count, double beta) {
    for (int i = 0; i < count; i++) {
        double step = values[i] - before[i], carried = beta * direction[i];
        values[i] += carried;
        direction[i] = carried + step;
    }
}

static void extrapolate(Reference *r, double beta) {
    extrapolate_numbers(&r->sums->normal, &r->sums_before->normal, &r->direction->normal, 2 * r->contact_count, beta);
    extrapolate_numbers(&r->momenta->x, &r->momenta_before->x, &r->momenta_direction->x, 3 * r->body_count, beta);
}

/* Back to before the last sweep. */
static void take_back(Reference *r) { memcpy(r->sums, r->sums_before, (size_t)r->contact_count * sizeof *r->sums); }

/* Ends with a sweep that began where another left off: its change is the residual of what the first one left, and
   that is kept. */
static void iterate(Reference *r, double tolerance, int max_sweeps) {
    double before = 0;
    bool from_sweep = false;
    memset(r->direction, 0, (size_t)r->contact_count * sizeof *r->direction);
    memset(r->momenta_direction, 0, (size_t)r->body_count * sizeof *r->momenta_direction);
    for (;;) {
        Sweep now = sweep(r);
        bool converged = !(now.change > tolerance);
        if (from_sweep && (converged || r->sweeps >= max_sweeps)) {
            r->residual = now.change;
            take_back(r);
            return;
        }
        bool last_is_next = converged || r->sweeps + 1 >= max_sweeps;
        double beta = last_is_next || !(now.along > 0) ? 0 : now.squared < before ? now.squared / before : 1;
        extrapolate(r, beta);
        from_sweep = beta == 0;
        before = now.squared;
    }
}

bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_sweeps,
                     const ContactImpulse *start, Error *error) {
    if (!reference_reserve(reference, problem)) return error_memory(error, "reference");
    reference_load(reference, problem);
    reference_start(reference, problem, start);
    iterate(reference, tolerance, max_sweeps);
    reference_hand_out(reference, problem);
    return true;
}

bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error) {
    if (!reference_reserve(reference, problem)) return error_memory(error, "reference");
    reference_load(reference, problem);
    reference_start(reference, problem, impulses);
    memset(reference->direction, 0, (size_t)reference->contact_count * sizeof *reference->direction);
    *residual = sweep(reference).change;
    return true;
}
