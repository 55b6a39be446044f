/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/pair_solver.h"

#include "common/array.h"
#include "sweeps/contact_velocity.h"
#include "sweeps/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void pair_solver_destroy(void *state) {
    PairSolver *solver = state;
    if (solver == NULL) return;
    pair_network_free(&solver->network);
    free(solver->pair_counts);
    free(solver);
}

PairSolver *pair_solver_create(const char *name, const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, name, "the scene names no network for it: use %s:network=FILE", name);
        return NULL;
    }
    PairSolver *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, name);
        return NULL;
    }
    solver->sweep_count = 10;
    bool predicts = true;
    if (settings_int(chosen, "k", 1, SWEEPS_MAX, &solver->sweep_count, error) &&
        settings_bool(chosen, "net", &predicts, error) && pair_network_read(&solver->network, path, error)) {
        solver->network.constant = !predicts;
        return solver;
    }
    pair_solver_destroy(solver);
    return NULL;
}

static BodyVelocity changed(const BodyVelocity *velocity, const ProblemBody *body, const float changes[3]) {
    if (body->inv_mass == 0.0f) return *velocity;
    return (BodyVelocity){vec2_add(velocity->linear, vec2(changes[0], changes[1])), velocity->angular + changes[2]};
}

static bool is_finite_velocity(const BodyVelocity *velocity) {
    return isfinite(velocity->linear.x) && isfinite(velocity->linear.y) && isfinite(velocity->angular);
}

/* The total momentum that changes of a pair create, N s. */
static double created_momentum(const ProblemBody *a, const ProblemBody *b, const float changes[PAIR_CHANGES]) {
    if (a->inv_mass == 0.0f || b->inv_mass == 0.0f) return 0;
    const double mass_a = 1.0 / a->inv_mass, mass_b = 1.0 / b->inv_mass;
    const double x = mass_a * changes[0] + mass_b * changes[3], y = mass_a * changes[1] + mass_b * changes[4];
    return sqrt(x * x + y * y);
}

/* A change with a NaN or infinite number is discarded and counted. */
static void add_changes(const PairNetwork *network, const ContactProblem *problem, int first,
                        const float changes[PAIR_CHANGES], ContactSolution *solution) {
    const int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    const BodyVelocity of_a = changed(&solution->velocities[a], body_a, changes);
    const BodyVelocity of_b = changed(&solution->velocities[b], body_b, changes + 3);
    if (!is_finite_velocity(&of_a) || !is_finite_velocity(&of_b)) {
        solution->fallbacks.not_finite++;
        return;
    }
    solution->velocities[a] = of_a;
    solution->velocities[b] = of_b;
    if (network->target == TARGET_NET || pair_network_outputs(network) == PAIR_CHANGES)
        solution->momentum_error += (float)created_momentum(body_a, body_b, changes);
}

static bool count_pairs(PairSolver *solver, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1;
    if (!array_reserve((void **)&solver->pair_counts, &solver->count_capacity, bodies, sizeof *solver->pair_counts))
        return false;
    memset(solver->pair_counts, 0, bodies * sizeof *solver->pair_counts);
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
        solver->pair_counts[problem->contacts[first].a]++;
        solver->pair_counts[problem->contacts[first].b]++;
    }
    return true;
}

/* TARGET_NET: every pair of a body predicts its whole change, so the body takes their mean. */
static void take_shares(const PairSolver *solver, const ContactPoint *contact, float changes[PAIR_CHANGES]) {
    for (int i = 0; i < PAIR_CHANGES; i++)
        changes[i] /= (float)solver->pair_counts[i < PAIR_CHANGES / 2 ? contact->a : contact->b];
}

/* TARGET_IMPULSE: sweeps over the pairs, each predicted from the current velocities. */
static void visit_pairs(PairSolver *solver, const ContactProblem *problem, ContactSolution *solution) {
    const PairMoment now = {.velocities = solution->velocities};
    for (int sweep = 0; sweep < solver->sweep_count; sweep++)
        for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
            float outputs[PAIR_CHANGES], changes[PAIR_CHANGES];
            pair_network_predict_one(&solver->network, problem, &now, first, outputs);
            pair_network_changes(&solver->network, problem, first, outputs, 1, changes);
            add_changes(&solver->network, problem, first, changes, solution);
        }
}

static ContactImpulse into_cone(ContactImpulse impulse, float friction) {
    const float normal = impulse.normal > 0.0f ? impulse.normal : 0.0f, most = friction * normal;
    return (ContactImpulse){normal, contact_clamp(impulse.tangent, -most, most)};
}

/* outputs: one number of the pair every `stride`. A point without outputs, or with NaN or infinite ones, keeps its warm
   start. */
static void push_points(const ContactProblem *problem, int first, const float *outputs, int stride,
                        ContactSolution *solution) {
    const int count = pair_contact_count(problem, first);
    const float inverse_mass = pair_inverse_mass(problem, first);
    for (int i = 0; i < count; i++) {
        const ContactPoint *contact = &problem->contacts[first + i];
        ContactImpulse impulse = {contact->warm_normal, contact->warm_tangent};
        if (i < PAIR_POINTS) {
            const float *beyond = outputs + 2 * i * stride;
            const ContactImpulse predicted = {impulse.normal + beyond[0] / inverse_mass,
                                              impulse.tangent + beyond[stride] / inverse_mass};
            if (isfinite(predicted.normal) && isfinite(predicted.tangent))
                impulse = predicted;
            else
                solution->fallbacks.not_finite++;
        }
        solution->impulses[first + i] = into_cone(impulse, contact->friction);
        solution->fallbacks.outside_cone += impulse.normal != solution->impulses[first + i].normal ||
                                            impulse.tangent != solution->impulses[first + i].tangent;
        contact_push(solution->velocities, contact, problem->bodies, solution->impulses[first + i]);
    }
}

bool pair_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    PairSolver *solver = state;
    PairNetwork *network = &solver->network;
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    solution->momentum_error = 0;
    solution->fallbacks = (NetworkFallbacks){0};
    if (network->target == TARGET_IMPULSE) {
        visit_pairs(solver, problem, solution);
        return true;
    }
    int pairs;
    const float *outputs = pair_network_predict(network, problem, &pairs);
    if (outputs == NULL || (network->target == TARGET_NET && !count_pairs(solver, problem)))
        return error_memory(error, "pair network");
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first), outputs++) {
        if (network->target == TARGET_POINTS) {
            push_points(problem, first, outputs, pairs, solution);
            continue;
        }
        float changes[PAIR_CHANGES];
        pair_network_changes(network, problem, first, outputs, pairs, changes);
        if (network->target == TARGET_NET) take_shares(solver, &problem->contacts[first], changes);
        add_changes(network, problem, first, changes, solution);
    }
    return true;
}
