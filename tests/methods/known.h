/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random problems with random networks that know them, for tests of the method scene-net. */
#pragma once
#include "kernels.h"
#include "scene_net_problems.h"

#include "methods/scene_net.h"

enum { RUNS = 40, AFTER = 6, REST = 20 };

static const float near_aim = 0.05f; /* m/s, of the solver */

/* A problem whose step a network knows. */
typedef struct Known {
    RandomProblem random;
    SceneNet *network;
    ContactSolution found, expected;
} Known;

/* The problem, whose bomb is the network's, is like its training. */
static inline void let_know(Known *known) {
    SceneNet *network = known->network;
    strcpy(network->scene, "random");
    network->bomb_inv_mass = known->random.bodies[network->bomb].inv_mass;
    network->gate = 0.01f;
    network->sweeps = AFTER;
    let_know_all(network);
    known->found = make_solution(&known->random.problem);
    known->expected = make_solution(&known->random.problem);
}

static inline void make_known(Known *known, uint32_t *seed, int run, float share) {
    known->network = make_scene_net_problem(&known->random, seed, 3 + run, 0.4f, share);
    while (known->random.problem.contact_count < 2) {
        scene_net_destroy(known->network);
        known->network = make_scene_net_problem(&known->random, seed, 3 + run, 0.4f, share);
    }
    known->random.problem.bomb = known->network->bomb;
    let_know(known);
}

static inline void free_known(Known *known) {
    scene_net_destroy(known->network);
    free_solution(&known->found);
    free_solution(&known->expected);
}

static inline void solve_by_network(Known *known) {
    Error error = {0};
    ContactSolver solver;
    assert_ok(scene_net_make(&solver, known->network, near_aim, &error), error);
    assert_ok(solver.kind->solve(solver.state, &known->random.problem, &known->found, &error), error);
    free_solver(&solver);
}

static inline void solve_by_momentum(Known *known) {
    Error error = {0};
    ContactSolver solver = make_solver(&solver_momentum, "k=20");
    assert_ok(solver.kind->solve(solver.state, &known->random.problem, &known->expected, &error), error);
    free_solver(&solver);
}

static inline bool same_bits(const Known *known) {
    return memcmp(known->found.velocities, known->expected.velocities,
                  (size_t)known->random.problem.body_count * sizeof *known->found.velocities) == 0;
}

static inline void assert_momentums_bits(Known *known, const char *what) {
    solve_by_network(known);
    solve_by_momentum(known);
    assert_same_bits(&known->random.problem, &known->found, &known->expected, what);
}
