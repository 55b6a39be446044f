/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Momentum sweeps, forward and backward. */
#include "learning/unrolled.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdlib.h>
#include <string.h>

/* A visit of one contact, with Jacobian rows J, inverse masses W and coupling c = J_t W J_n^T:

       forward                                            backward, x* the derivative of the loss by x, w* = W v*
       Pn' = max(Pn - m_n (J_n v - bias), 0)              Pt'* += J_t w*,  Pn'* += J_n w*
       Pt' = clamp(Pt - m_t (J_t v + c dPn), +-mu Pn')    Pt'* into m_t J_t v, c dPn, Pt or into mu Pn'
       v'  = v + W (J_n^T dPn + J_t^T dPt)                w*  += W (J_n^T (J_n v)* + J_t^T (J_t v)*)

   w* behaves like a velocity, so both passes share velocity_along() and push(). */

/* The piece that the clamps took: 3 if the normal impulse is above 0, plus 0, 1 or 2 for a tangent impulse at the lower
   limit of the cone, inside, or at the upper limit. With a limit of 0 there is no inside. */
static inline uint8_t piece_of(double normal, double tangent, double limit) {
    return (uint8_t)(3 * (normal > 0) + (tangent > -limit) + (tangent > limit));
}

/* Lookup tables: branches mispredict at impacts. */
static const double pushes[6] = {0, 0, 0, 1, 1, 1}, within[6] = {0, 1, 0, 0, 1, 0}, side[6] = {-1, 0, 1, -1, 0, 1};

static inline double clamp(double value, double limit) {
    double capped = value < limit ? value : limit;
    return capped > -limit ? capped : -limit;
}

static void make_row(double row[4], Vec2 direction, const ContactPoint *point) {
    row[0] = (double)direction.x;
    row[1] = (double)direction.y;
    row[2] = (double)point->arm_a.y * row[0] - (double)point->arm_a.x * row[1];
    row[3] = (double)point->arm_b.x * row[1] - (double)point->arm_b.y * row[0];
}

bool unrolled_problem_make(UnrolledProblem *unrolled, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    Colours colours = {0};
    UnrolledContact *block =
        malloc(contacts * (sizeof *block + sizeof *unrolled->visits) + (5 * bodies + 1) * sizeof(double));
    if (block == NULL || !colours_order(&colours, problem)) {
        free(block);
        colours_free(&colours);
        return false;
    }
    double *numbers = (double *)(block + contacts);
    int32_t *visits = (int32_t *)(numbers + 5 * bodies);
    *unrolled = (UnrolledProblem){.body_count = problem->body_count,
                                  .contact_count = problem->contact_count,
                                  .contacts = block,
                                  .visits = visits,
                                  .inv_mass = numbers,
                                  .inv_inertia = numbers + bodies,
                                  .free = numbers + 2 * bodies};
    if (contacts > 0) memcpy(visits, colours.visits, contacts * sizeof *visits);
    colours_free(&colours);
    for (size_t i = 0; i < contacts; i++) {
        const ContactPoint *point = &problem->contacts[i];
        UnrolledContact *contact = &block[i];
        *contact = (UnrolledContact){.a = point->a,
                                     .b = point->b,
                                     .mass_normal = (double)point->mass_normal,
                                     .mass_tangent = (double)point->mass_tangent,
                                     .friction = (double)point->friction,
                                     .bias = (double)point->bias};
        make_row(contact->normal, point->normal, point);
        make_row(contact->tangent, vec2_cross_scalar(point->normal, 1.0f), point);
        /* The directions are perpendicular, so only the angular parts couple. */
        contact->coupling = (double)problem->bodies[point->a].inv_inertia * contact->normal[2] * contact->tangent[2] +
                            (double)problem->bodies[point->b].inv_inertia * contact->normal[3] * contact->tangent[3];
    }
    for (size_t i = 0; i < bodies; i++) {
        const ProblemBody *body = &problem->bodies[i];
        unrolled->inv_mass[i] = (double)body->inv_mass;
        unrolled->inv_inertia[i] = (double)body->inv_inertia;
        unrolled->free[3 * i] = (double)body->velocity.x;
        unrolled->free[3 * i + 1] = (double)body->velocity.y;
        unrolled->free[3 * i + 2] = (double)body->angular_velocity;
    }
    return true;
}

void unrolled_problem_free(UnrolledProblem *problem) {
    free(problem->contacts);
    *problem = (UnrolledProblem){0};
}

void unrolled_free(Unrolled *unrolled) {
    free(unrolled->states);
    free(unrolled->pieces);
    free(unrolled->factors);
    free(unrolled->adjoints);
    *unrolled = (Unrolled){0};
}

static size_t state_size(const UnrolledProblem *problem) {
    return 3 * (size_t)problem->body_count + 2 * (size_t)problem->contact_count;
}

/* Relative velocity of b's contact point along a row. */
static inline double velocity_along(const double row[4], const double *a, const double *b) {
    return row[0] * (b[0] - a[0]) + row[1] * (b[1] - a[1]) + (row[2] * a[2] + row[3] * b[2]);
}

static inline void push(const UnrolledProblem *problem, const UnrolledContact *contact, double *velocities,
                        double normal, double tangent) {
    double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    double effect[4];
    for (int i = 0; i < 4; i++) effect[i] = normal * contact->normal[i] + tangent * contact->tangent[i];
    const double inv_a = problem->inv_mass[contact->a], inv_b = problem->inv_mass[contact->b];
    a[0] -= inv_a * effect[0];
    a[1] -= inv_a * effect[1];
    a[2] += problem->inv_inertia[contact->a] * effect[2];
    b[0] += inv_b * effect[0];
    b[1] += inv_b * effect[1];
    b[2] += problem->inv_inertia[contact->b] * effect[3];
}

/* One contact update; returns the piece. */
static inline uint8_t visit(const UnrolledProblem *problem, const UnrolledContact *contact, double *velocities,
                            double *impulse) {
    const double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    const double normal = impulse[0] - contact->mass_normal * (velocity_along(contact->normal, a, b) - contact->bias);
    const double pushed = normal > 0 ? normal : 0, by_normal = pushed - impulse[0];
    const double sliding = velocity_along(contact->tangent, a, b) + contact->coupling * by_normal;
    const double tangent = impulse[1] - contact->mass_tangent * sliding, limit = contact->friction * pushed;
    const double dragged = clamp(tangent, limit);
    push(problem, contact, velocities, by_normal, dragged - impulse[1]);
    impulse[0] = pushed;
    impulse[1] = dragged;
    return piece_of(normal, tangent, limit);
}

/* Turns the adjoints after the visit into those before it. */
static inline void visit_back(const UnrolledProblem *problem, const UnrolledContact *contact, uint8_t piece,
                              double *velocities, double *impulse) {
    const double *a = velocities + 3 * contact->a, *b = velocities + 3 * contact->b;
    const double along_normal = velocity_along(contact->normal, a, b);
    const double along_tangent = velocity_along(contact->tangent, a, b);
    const double dragged = impulse[1] + along_tangent, inside = within[piece] * dragged;
    const double by_sliding = -contact->mass_tangent * inside;
    const double by_normal = along_normal + contact->coupling * by_sliding;
    const double pushed = pushes[piece] * (impulse[0] + by_normal + side[piece] * contact->friction * dragged);
    push(problem, contact, velocities, -contact->mass_normal * pushed, by_sliding);
    impulse[0] = pushed - by_normal;
    impulse[1] = inside - along_tangent;
}

/* The derivative by a contact's impulse, including its effect on the velocities. */
static inline void by_impulse(const UnrolledProblem *problem, int contact, const double *adjoint, double by[2]) {
    const UnrolledContact *at = &problem->contacts[contact];
    const double *a = adjoint + 3 * at->a, *b = adjoint + 3 * at->b;
    const double *impulse = adjoint + 3 * problem->body_count + 2 * contact;
    by[0] = impulse[0] + velocity_along(at->normal, a, b);
    by[1] = impulse[1] + velocity_along(at->tangent, a, b);
}

bool unrolled_run(Unrolled *unrolled, const UnrolledProblem *problem, const double *start, const double *factors,
                  int sweeps) {
    const size_t count = (size_t)sweeps, size = state_size(problem), contacts = (size_t)problem->contact_count;
    if (!array_reserve((void **)&unrolled->states, &unrolled->state_capacity, (count + 1) * size + 1,
                       sizeof *unrolled->states) ||
        !array_reserve((void **)&unrolled->pieces, &unrolled->piece_capacity, (count + 1) * contacts + 1,
                       sizeof *unrolled->pieces) ||
        !array_reserve((void **)&unrolled->factors, &unrolled->factor_capacity, count + 1, sizeof *unrolled->factors) ||
        !array_reserve((void **)&unrolled->adjoints, &unrolled->adjoint_capacity, 2 * size + 1,
                       sizeof *unrolled->adjoints))
        return false;
    double *now = unrolled->states;
    memcpy(now, problem->free, 3 * (size_t)problem->body_count * sizeof *now);
    for (size_t i = 0; i < contacts; i++) {
        const UnrolledContact *contact = &problem->contacts[i];
        double *impulse = now + 3 * problem->body_count + 2 * i;
        const double normal = start[2 * i] > 0 ? start[2 * i] : 0, limit = contact->friction * normal;
        impulse[0] = normal;
        impulse[1] = clamp(start[2 * i + 1], limit);
        unrolled->pieces[i] = piece_of(start[2 * i], start[2 * i + 1], limit);
        push(problem, contact, now, impulse[0], impulse[1]);
    }
    for (size_t s = 0; s < count; s++, now += size) {
        const double factor = unrolled->factors[s] = s > 0 ? factors[s] : 0;
        const double *before = s > 0 ? now - size : now;
        double *next = now + size;
        for (size_t i = 0; i < size; i++) next[i] = now[i] + factor * (now[i] - before[i]);
        uint8_t *pieces = unrolled->pieces + (s + 1) * contacts;
        double *impulses = next + 3 * problem->body_count;
        for (size_t i = 0; i < contacts; i++) {
            const int32_t at = problem->visits[i];
            pieces[at] = visit(problem, &problem->contacts[at], next, impulses + 2 * at);
        }
    }
    unrolled->sweeps = sweeps;
    unrolled->velocities = now;
    unrolled->impulses = now + 3 * problem->body_count;
    return true;
}

void unrolled_back(Unrolled *unrolled, const UnrolledProblem *problem, const double *by_velocity, double *by_start,
                   double *by_factors) {
    const size_t size = state_size(problem), contacts = (size_t)problem->contact_count;
    double *adjoint = unrolled->adjoints, *impulses = adjoint + 3 * problem->body_count;
    double *later = adjoint + size; /* contribution of the extrapolation one sweep later */
    memset(adjoint, 0, 2 * size * sizeof *adjoint);
    for (int i = 0; i < problem->body_count; i++) {
        adjoint[3 * i] = problem->inv_mass[i] * by_velocity[3 * i];
        adjoint[3 * i + 1] = problem->inv_mass[i] * by_velocity[3 * i + 1];
        adjoint[3 * i + 2] = problem->inv_inertia[i] * by_velocity[3 * i + 2];
    }
    for (size_t s = (size_t)unrolled->sweeps; s-- > 0;) {
        const uint8_t *pieces = unrolled->pieces + (s + 1) * contacts;
        for (size_t i = contacts; i-- > 0;) {
            const int32_t at = problem->visits[i];
            visit_back(problem, &problem->contacts[at], pieces[at], adjoint, impulses + 2 * at);
        }
        if (by_factors != NULL && s > 0) {
            const double *now = unrolled->states + s * size + 3 * problem->body_count, *before = now - size;
            double sum = 0;
            for (size_t i = 0; i < contacts; i++) {
                double by[2];
                by_impulse(problem, (int)i, adjoint, by);
                sum += by[0] * (now[2 * i] - before[2 * i]) + by[1] * (now[2 * i + 1] - before[2 * i + 1]);
            }
            by_factors[s] += sum;
        }
        const double factor = unrolled->factors[s];
        for (size_t i = 0; i < size; i++) {
            const double at = adjoint[i];
            adjoint[i] = at + factor * at + later[i];
            later[i] = -factor * at;
        }
    }
    for (int i = 0; i < problem->contact_count; i++) {
        double by[2];
        by_impulse(problem, i, adjoint, by);
        const uint8_t piece = unrolled->pieces[i];
        by_start[2 * i] = pushes[piece] * (by[0] + side[piece] * problem->contacts[i].friction * by[1]);
        by_start[2 * i + 1] = within[piece] * by[1];
    }
}
