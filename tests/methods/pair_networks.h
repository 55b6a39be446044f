/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of pairs for tests, and the solvers that use them. */
#pragma once
#include "base/settings.h"
#include "made.h"
#include "worlds.h"

#include "methods/pair.h"

/* Any six changes. */
static const float six[PAIR_CHANGES] = {1, 2, 3, 4, 5, 6};

/* A chain 0 - 1 - 2 of moving bodies. */
static const ContactPoint chain_contacts[2] = {{.a = 0, .b = 1, .normal = {0, 1}, .warm_normal = 9},
                                               {.a = 1, .b = 2, .normal = {0, 1}, .warm_normal = 9}};
static const ProblemBody chain_bodies[3] = {
    {.inv_mass = 0.5f, .inv_inertia = 3, .velocity = {1, 0}}, {.inv_mass = 1}, {.inv_mass = 0.25f}};
static const ContactProblem chain = {
    .body_count = 3, .contact_count = 2, .bomb = -1, .bodies = chain_bodies, .contacts = chain_contacts};

/* One linear layer of zeros with the texts of its view and target. */
static inline Network *make_pair_network(PairView view, PairTarget target, int outputs) {
    Network *network = network_sized(1, (const int[]){pair_views[view].count, outputs});
    strcpy(network->inputs, pair_views[view].inputs);
    strcpy(network->outputs, pair_output_names(view, target, outputs));
    strcpy(network->target, pair_target_names[target]);
    return network;
}

/* Its file; the network goes. */
static inline const char *write_pair_network(Network *network) {
    Error error = {0};
    const char *path = temporary_path("network.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    return path;
}

/* A network that says the same whatever it sees, trained on data whose mean was twice that. */
static inline const char *constant_network(PairView view, PairTarget target, int outputs, const float *values) {
    Network *network = make_pair_network(view, target, outputs);
    for (int i = 0; i < outputs; i++) {
        network->biases[0][i] = values[i];
        network->output_mean[i] = 2 * values[i];
    }
    return write_pair_network(network);
}

static inline ContactSolver make_network_solver(const ContactSolverKind *kind, const char *path, int sweeps) {
    char text[512];
    bool has_k = kind != &solver_contact_net;
    snprintf(text, sizeof text, has_k ? "network=%s,k=%d" : "network=%s", path, sweeps);
    return make_solver(kind, text);
}

/* Solves a problem by the network of a file. */
static inline ContactSolution solution_by(const ContactSolverKind *kind, const char *path, int sweeps,
                                          const ContactProblem *problem, BodyVelocity *velocities,
                                          ContactImpulse *impulses) {
    Error error = {0};
    ContactSolver solver = make_network_solver(kind, path, sweeps);
    ContactSolution solution = {velocities, impulses, -1, {-1, -1, -1, -1, -1, -1}};
    assert_ok(solver.kind->solve(solver.state, problem, &solution, &error), error);
    free_solver(&solver);
    return solution;
}

/* Returns what the solution says of momentum. */
static inline float solve_by(const ContactSolverKind *kind, const char *path, int sweeps, const ContactProblem *problem,
                             BodyVelocity *velocities, ContactImpulse *impulses) {
    return solution_by(kind, path, sweeps, problem, velocities, impulses).momentum_error;
}

static inline void assert_fallbacks(const ContactSolution *solution, int not_finite, int outside_cone,
                                    int beyond_training) {
    assert_int_equal(solution->fallbacks.not_finite, not_finite);
    assert_int_equal(solution->fallbacks.outside_cone, outside_cone);
    assert_int_equal(solution->fallbacks.beyond_training, beyond_training);
}

/* The file is refused by the solver, which says why. */
static inline void assert_network_refused(const ContactSolverKind *kind, const char *path, const char *text) {
    Error error = {0};
    Settings settings = {0};
    assert_true(settings_default(&settings, "network", path));
    assert_refused(kind->create(&settings, &error), text, path);
}
