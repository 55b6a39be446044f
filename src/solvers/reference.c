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
#include "solvers/reference.h"

#include "common/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One direction of a contact: what an impulse along it sees of the two bodies. */
typedef struct ReferenceRow {
    double x, y;           /* the direction */
    double turn_a, turn_b; /* lever arm x direction, m */
    double mass;           /* effective, kg */
} ReferenceRow;

struct ReferenceContact {
    int a, b;
    double inv_mass_a, inv_inertia_a, inv_mass_b, inv_inertia_b;
    ReferenceRow normal, tangent;
    double bias, friction;
};

void reference_free(Reference *reference) {
    free(reference->velocities);
    free(reference->velocities_before);
    free(reference->velocity_direction);
    free(reference->contacts);
    free(reference->impulses);
    free(reference->impulses_before);
    free(reference->direction);
    *reference = (Reference){0};
}

static bool reserve(Reference *r, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    ReferenceVelocity **of_bodies[] = {&r->velocities, &r->velocities_before, &r->velocity_direction};
    ReferenceImpulse **of_contacts[] = {&r->impulses, &r->impulses_before, &r->direction};
    for (int i = 0; i < 3; i++)
        if (!array_reserve((void **)of_bodies[i], &r->body_capacity[i], bodies, sizeof **of_bodies[i]) ||
            !array_reserve((void **)of_contacts[i], &r->contact_capacity[i], contacts, sizeof **of_contacts[i]))
            return false;
    return array_reserve((void **)&r->contacts, &r->contact_capacity[3], contacts, sizeof *r->contacts);
}

static ReferenceRow make_row(const ContactPoint *contact, double x, double y, double mass) {
    return (ReferenceRow){.x = x,
                          .y = y,
                          .turn_a = (double)contact->arm_a.x * y - (double)contact->arm_a.y * x,
                          .turn_b = (double)contact->arm_b.x * y - (double)contact->arm_b.y * x,
                          .mass = mass};
}

static void load(Reference *r, const ContactProblem *problem) {
    r->body_count = problem->body_count;
    r->contact_count = problem->contact_count;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
        double x = (double)contact->normal.x, y = (double)contact->normal.y;
        r->contacts[i] = (ReferenceContact){.a = contact->a,
                                            .b = contact->b,
                                            .inv_mass_a = (double)a->inv_mass,
                                            .inv_inertia_a = (double)a->inv_inertia,
                                            .inv_mass_b = (double)b->inv_mass,
                                            .inv_inertia_b = (double)b->inv_inertia,
                                            .normal = make_row(contact, x, y, (double)contact->mass_normal),
                                            .tangent = make_row(contact, y, -x, (double)contact->mass_tangent),
                                            .bias = (double)contact->bias,
                                            .friction = (double)contact->friction};
    }
}

static double relative_velocity(const ReferenceVelocity *a, const ReferenceVelocity *b, const ReferenceRow *row) {
    return row->x * (b->x - a->x) + row->y * (b->y - a->y) + (row->turn_b * b->spin - row->turn_a * a->spin);
}

static void apply(ReferenceVelocity *a, ReferenceVelocity *b, const ReferenceContact *contact, const ReferenceRow *row,
                  double impulse) {
    double of_a = contact->inv_mass_a * impulse, of_b = contact->inv_mass_b * impulse;
    a->x -= of_a * row->x;
    a->y -= of_a * row->y;
    a->spin -= contact->inv_inertia_a * impulse * row->turn_a;
    b->x += of_b * row->x;
    b->y += of_b * row->y;
    b->spin += contact->inv_inertia_b * impulse * row->turn_b;
}

/* Velocities from the impulses, without the rounding of many sweeps. */
static void apply_all(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        r->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        ReferenceVelocity *a = &r->velocities[contact->a], *b = &r->velocities[contact->b];
        apply(a, b, contact, &contact->normal, r->impulses[i].normal);
        apply(a, b, contact, &contact->tangent, r->impulses[i].tangent);
    }
}

static double larger(double x, double y) { return x > y ? x : y; }

/* One contact, once. Returns the larger change of its two relative velocities. */
static double solve_contact(const ReferenceContact *contact, ReferenceVelocity *velocities, ReferenceImpulse *impulse) {
    ReferenceVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];
    const ReferenceRow *normal = &contact->normal, *tangent = &contact->tangent;
    double total = impulse->normal + normal->mass * (contact->bias - relative_velocity(a, b, normal));
    total = total > 0 ? total : 0;
    double pushed = total - impulse->normal;
    impulse->normal = total;
    apply(a, b, contact, normal, pushed);

    double limit = contact->friction * impulse->normal;
    total = impulse->tangent - tangent->mass * relative_velocity(a, b, tangent);
    total = total < limit ? total : limit;
    total = total > -limit ? total : -limit;
    double dragged = total - impulse->tangent;
    impulse->tangent = total;
    apply(a, b, contact, tangent, dragged);
    return larger(fabs(pushed) / normal->mass, fabs(dragged) / tangent->mass);
}

/* One sweep over all contacts; returns the largest change of a relative velocity. */
static double sweep(Reference *r) {
    memcpy(r->velocities_before, r->velocities, (size_t)r->body_count * sizeof *r->velocities);
    memcpy(r->impulses_before, r->impulses, (size_t)r->contact_count * sizeof *r->impulses);
    double change = 0;
    for (int i = 0; i < r->contact_count; i++)
        change = larger(change, solve_contact(&r->contacts[i], r->velocities, &r->impulses[i]));
    r->sweeps++;
    return change;
}

/* Of the last sweep's step: |g|^2, and -g d with the direction of the sweeps before. Each impulse is weighed so that
   the sums are energies: bodies of unlike mass count alike. */
typedef struct Step {
    double squared, along;
} Step;

static Step measure_step(const Reference *r) {
    Step sum = {0, 0};
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        double normal = r->impulses[i].normal - r->impulses_before[i].normal;
        double tangent = r->impulses[i].tangent - r->impulses_before[i].tangent;
        sum.squared += normal * normal / contact->normal.mass + tangent * tangent / contact->tangent.mass;
        sum.along += normal * r->direction[i].normal / contact->normal.mass +
                     tangent * r->direction[i].tangent / contact->tangent.mass;
    }
    return sum;
}

/* p = p' + beta d and d' = beta d - g for one number. */
static void extrapolate_number(double *value, double before, double *direction, double beta) {
    double step = *value - before, carried = beta * *direction;
    *value += carried;
    *direction = carried + step;
}

static void extrapolate(Reference *r, double beta) {
    for (int i = 0; i < r->contact_count; i++) {
        extrapolate_number(&r->impulses[i].normal, r->impulses_before[i].normal, &r->direction[i].normal, beta);
        extrapolate_number(&r->impulses[i].tangent, r->impulses_before[i].tangent, &r->direction[i].tangent, beta);
    }
    for (int i = 0; i < r->body_count; i++) {
        ReferenceVelocity *v = &r->velocities[i], *d = &r->velocity_direction[i];
        const ReferenceVelocity *before = &r->velocities_before[i];
        extrapolate_number(&v->x, before->x, &d->x, beta);
        extrapolate_number(&v->y, before->y, &d->y, beta);
        extrapolate_number(&v->spin, before->spin, &d->spin, beta);
    }
}

/* Back to before the last sweep. */
static void take_back(Reference *r) {
    memcpy(r->velocities, r->velocities_before, (size_t)r->body_count * sizeof *r->velocities);
    memcpy(r->impulses, r->impulses_before, (size_t)r->contact_count * sizeof *r->impulses);
}

/* Ends with a sweep that began where another left off: its change is the residual of what the first one left, and
   that is kept. */
static void iterate(Reference *r, double tolerance, int max_sweeps) {
    double before = 0;
    bool from_sweep = false;
    memset(r->direction, 0, (size_t)r->contact_count * sizeof *r->direction);
    memset(r->velocity_direction, 0, (size_t)r->body_count * sizeof *r->velocity_direction);
    for (;;) {
        double change = sweep(r);
        bool at_end = !(change > tolerance) || r->sweeps + 1 >= max_sweeps;
        if (from_sweep && at_end) {
            r->residual = change;
            take_back(r);
            return;
        }
        Step step = measure_step(r);
        double beta = at_end || !(step.along > 0) ? 0 : step.squared < before ? step.squared / before : 1;
        extrapolate(r, beta);
        from_sweep = beta == 0;
        before = step.squared;
    }
}

static void start_from(Reference *r, const ContactProblem *problem, const ContactImpulse *start) {
    for (int i = 0; i < r->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse impulse =
            start != NULL ? start[i] : (ContactImpulse){contact->warm_normal, contact->warm_tangent};
        r->impulses[i] = (ReferenceImpulse){(double)impulse.normal, (double)impulse.tangent};
    }
    apply_all(r, problem);
}

bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_sweeps,
                     const ContactImpulse *start, Error *error) {
    if (!reserve(reference, problem)) return error_memory(error, "reference");
    load(reference, problem);
    start_from(reference, problem, start);
    reference->sweeps = 0;
    iterate(reference, tolerance, max_sweeps);
    apply_all(reference, problem);
    return true;
}
