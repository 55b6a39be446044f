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

enum { ROUNDS = 64 };

/* One direction of a contact, in units in which every mass is 1: velocities are times the root of the mass, impulses
   through the root of the contact's effective mass. There an impulse q changes the velocities by q times the row, and
   its own relative velocity, row * velocities, by q. */
typedef struct ReferenceRow {
    double a[3], b[3]; /* x, y, spin of the two bodies */
    double target;     /* the relative velocity that no impulse changes any more */
    double scale;      /* root of the effective mass, kg^(1/2): impulse in N s = scale q, velocity in m/s = q / scale */
} ReferenceRow;

struct ReferenceContact {
    int index, a, b; /* in the problem */
    ReferenceRow normal, tangent;
    double friction; /* of impulses in the units above */
};

void reference_free(Reference *reference) {
    free(reference->velocities);
    free(reference->momenta);
    free(reference->momenta_before);
    free(reference->momenta_direction);
    free(reference->contacts);
    free(reference->impulses);
    free(reference->sums);
    free(reference->sums_before);
    free(reference->direction);
    free(reference->rounds);
    free(reference->taken);
    *reference = (Reference){0};
}

static bool reserve(Reference *r, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    ReferenceVelocity **of_bodies[] = {&r->velocities, &r->momenta, &r->momenta_before, &r->momenta_direction};
    ReferenceImpulse **of_contacts[] = {&r->impulses, &r->sums, &r->sums_before, &r->direction};
    for (int i = 0; i < 4; i++)
        if (!array_reserve((void **)of_bodies[i], &r->body_capacity[i], bodies, sizeof **of_bodies[i]) ||
            !array_reserve((void **)of_contacts[i], &r->contact_capacity[i], contacts, sizeof **of_contacts[i]))
            return false;
    return array_reserve((void **)&r->contacts, &r->contact_capacity[4], contacts, sizeof *r->contacts) &&
           array_reserve((void **)&r->rounds, &r->contact_capacity[5], contacts, sizeof *r->rounds) &&
           array_reserve((void **)&r->taken, &r->body_capacity[4], bodies, sizeof *r->taken);
}

/* Half a row: what an impulse along x, y does to one body; a velocity that no impulse changes goes to the target. */
static void load_half(ReferenceRow *row, double half[3], const ProblemBody *body, Vec2 arm, double x, double y) {
    const double inverse[] = {(double)body->inv_mass, (double)body->inv_mass, (double)body->inv_inertia};
    const double velocity[] = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    const double along[] = {x, y, (double)arm.x * y - (double)arm.y * x};
    for (int i = 0; i < 3; i++) {
        if (inverse[i] == 0) row->target -= row->scale * along[i] * velocity[i];
        half[i] = row->scale * sqrt(inverse[i]) * along[i];
    }
}

static void add_impulse(ReferenceVelocity *velocity, const ProblemBody *body, Vec2 arm, double x, double y) {
    velocity->x += (double)body->inv_mass * x;
    velocity->y += (double)body->inv_mass * y;
    velocity->spin += (double)body->inv_inertia * ((double)arm.x * y - (double)arm.y * x);
}

static ReferenceRow load_row(const ContactProblem *problem, const ContactPoint *contact, double x, double y,
                             double mass, double target) {
    ReferenceRow row = {.scale = sqrt(mass)};
    row.target = row.scale * target;
    load_half(&row, row.a, &problem->bodies[contact->a], contact->arm_a, -x, -y);
    load_half(&row, row.b, &problem->bodies[contact->b], contact->arm_b, x, y);
    return row;
}

static void load_contact(ReferenceContact *out, const ContactProblem *problem, int index) {
    const ContactPoint *contact = &problem->contacts[index];
    double x = (double)contact->normal.x, y = (double)contact->normal.y;
    out->index = index;
    out->a = contact->a;
    out->b = contact->b;
    out->normal = load_row(problem, contact, x, y, (double)contact->mass_normal, (double)contact->bias);
    out->tangent = load_row(problem, contact, y, -x, (double)contact->mass_tangent, 0);
    out->friction = (double)contact->friction * out->normal.scale / out->tangent.scale;
}

static bool moves(const ProblemBody *body) { return body->inv_mass != 0.0f || body->inv_inertia != 0.0f; }

/* The first round in which neither moving body is taken yet; the last round takes all that are left over. */
static int find_round(Reference *r, const ContactProblem *problem, const ContactPoint *contact) {
    uint64_t none = 0, *taken_a = moves(&problem->bodies[contact->a]) ? &r->taken[contact->a] : &none;
    uint64_t also_none = 0, *taken_b = moves(&problem->bodies[contact->b]) ? &r->taken[contact->b] : &also_none;
    int round = 0;
    while (round < ROUNDS - 1 && ((*taken_a | *taken_b) >> round & 1) != 0) round++;
    *taken_a |= (uint64_t)1 << round;
    *taken_b |= (uint64_t)1 << round;
    return round;
}

static bool same_pair(const ContactPoint *x, const ContactPoint *y) { return x->a == y->a && x->b == y->b; }

/* In rounds of pairs that share no moving body: visits that do not wait for each other are done by the processor at
   the same time. */
static void load(Reference *r, const ContactProblem *problem) {
    r->body_count = problem->body_count;
    r->contact_count = problem->contact_count;
    memset(r->taken, 0, (size_t)problem->body_count * sizeof *r->taken);
    int last_round = 0, loaded = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        bool again = i > 0 && same_pair(contact, contact - 1);
        r->rounds[i] = again ? r->rounds[i - 1] : find_round(r, problem, contact);
        if (r->rounds[i] > last_round) last_round = r->rounds[i];
    }
    for (int round = 0; round <= last_round; round++)
        for (int i = 0; i < problem->contact_count; i++)
            if (r->rounds[i] == round) load_contact(&r->contacts[loaded++], problem, i);
}

/* The velocities that impulses give, in the problem's units and order. */
static void apply_impulses(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        r->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        double normal = r->impulses[i].normal, tangent = r->impulses[i].tangent;
        double x = (double)contact->normal.x * normal + (double)contact->normal.y * tangent;
        double y = (double)contact->normal.y * normal - (double)contact->normal.x * tangent;
        add_impulse(&r->velocities[contact->a], &problem->bodies[contact->a], contact->arm_a, -x, -y);
        add_impulse(&r->velocities[contact->b], &problem->bodies[contact->b], contact->arm_b, x, y);
    }
}

static double scaled(double velocity, float inverse) { return inverse != 0.0f ? velocity / sqrt((double)inverse) : 0; }

static void start_from(Reference *r, const ContactProblem *problem, const ContactImpulse *start) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse impulse =
            start != NULL ? start[i] : (ContactImpulse){contact->warm_normal, contact->warm_tangent};
        r->impulses[i] = (ReferenceImpulse){(double)impulse.normal, (double)impulse.tangent};
    }
    apply_impulses(r, problem);
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const ReferenceVelocity *velocity = &r->velocities[i];
        r->momenta[i] = (ReferenceVelocity){scaled(velocity->x, body->inv_mass), scaled(velocity->y, body->inv_mass),
                                            scaled(velocity->spin, body->inv_inertia)};
    }
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        const ReferenceImpulse *impulse = &r->impulses[contact->index];
        r->sums[i] =
            (ReferenceImpulse){impulse->normal / contact->normal.scale, impulse->tangent / contact->tangent.scale};
    }
    r->sweeps = 0;
}

static void hand_out(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        r->impulses[contact->index] =
            (ReferenceImpulse){r->sums[i].normal * contact->normal.scale, r->sums[i].tangent * contact->tangent.scale};
    }
    apply_impulses(r, problem);
}

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
    if (!reserve(reference, problem)) return error_memory(error, "reference");
    load(reference, problem);
    start_from(reference, problem, start);
    iterate(reference, tolerance, max_sweeps);
    hand_out(reference, problem);
    return true;
}

bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error) {
    if (!reserve(reference, problem)) return error_memory(error, "reference");
    load(reference, problem);
    start_from(reference, problem, impulses);
    memset(reference->direction, 0, (size_t)reference->contact_count * sizeof *reference->direction);
    *residual = sweep(reference).change;
    return true;
}
