/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step allocates nothing once the world has warmed up. */
#include "allocations.h"
#include "pair_networks.h"
#include "methods/sain_networks.h"
#include "scene_net_problems.h"

#include "methods/sain.h"
#include "methods/scene_net.h"
#include "base/settings.h"

static World *make_pyramid(void) {
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int row = 0; row < 11; row++)
        for (int i = row; i < 11; i++) {
            float x = 1.125f * ((float)i - 0.5f * (float)row);
            add_box(world, 10, 0.2f, vec2(x, 0.5f + (float)row));
        }
    return world;
}

static void steps_allocate_nothing_by(const ContactSolverKind *kind, const char *text) {
    OWN(World) *world = make_pyramid();
    allocations = 0;
    OWN(ContactSolver) solver = make_solver(kind, text);
    run(world, &solver, 60);
    assert_true(allocations > 10);
    allocations = 0;
    run(world, &solver, 60);
    assert_int_equal(allocations, 0);
}

/* By all solvers of the registry that need no program and no network, and hybrid's sweeps. */
TEST(a_settled_pyramid_steps_without_allocating) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        if (kind->solver == NULL || method->external || (method->needs_network && kind->solver != &solver_hybrid))
            continue;
        steps_allocate_nothing_by(kind->solver, "");
        if (settings_known(method->settings, "near") && settings_known(method->settings, "k"))
            steps_allocate_nothing_by(kind->solver, "k=7,near=1e-4");
    }
}

/* The network's pyramid would not stand, so each is asked about the engine's, twice. */
TEST(pair_networks_solve_without_allocating) {
    OWN(World) *world = make_pyramid();
    OWN(ContactSolver) engine = make_engine("");
    run(world, &engine, 10);
    const ContactProblem *problem = world_problem(world);
    ContactSolution solution = *world_solution(world);
    for (PairTarget target = TARGET_PAIR; target < PAIR_TARGETS; target++) {
        const PairView view = target == TARGET_IMPULSE ? PAIR_RELATIVE : PAIR_NEIGHBOURS;
        const ContactSolverKind *kind = target == TARGET_POINTS ? &solver_contact_net : &solver_pair_net;
        OWN(ContactSolver)
        solver = make_network_solver(kind, constant_network(view, target, pair_change_count(target), six), 3);
        allocations = 0;
        assert_ok(kind->solve(solver.state, problem, &solution, &error), error);
        assert_int_equal(allocations > 0, target != TARGET_IMPULSE);
        allocations = 0;
        assert_ok(kind->solve(solver.state, problem, &solution, &error), error);
        assert_int_equal(allocations, 0);
    }
}

TEST(a_view_of_no_larger_problem_allocates_nothing) {
    static RandomProblem large, small;
    uint32_t seed = 1;
    SceneView view = {0};
    OWN(SceneNet) *network = make_scene_net_problem(&large, &seed, 20, 0.5f, 1);
    OWN(SceneNet) *smaller = make_scene_net_problem(&small, &seed, 12, 0.5f, 1);
    allocations = 0;
    assert_true(scene_view_take(&view, network, &large.problem));
    assert_true(allocations > 0);
    allocations = 0;
    assert_true(scene_view_take(&view, network, &large.problem));
    assert_true(scene_view_take(&view, smaller, &small.problem));
    assert_true(scene_view_take(&view, network, &large.problem));
    assert_int_equal(allocations, 0);
    scene_view_free(&view);
}

TEST(a_network_of_a_scene_solves_without_allocating) {
    static RandomProblem random;
    uint32_t seed = 4;
    OWN(ContactSolver) solver;
    BodyVelocity velocities[BODIES_MAX];
    ContactImpulse impulses[CONTACTS_MAX];
    ContactSolution solution = {velocities, impulses, 0, {0}};
    OWN(SceneNet) *network = make_scene_net_problem(&random, &seed, 20, 0.5f, 0.7f);
    random.problem.bomb = network->bomb;
    network->bomb_inv_mass = random.bodies[network->bomb].inv_mass;
    network->sweeps = 6;
    let_know_all(network);
    assert_ok(scene_net_make(&solver, network, 0.05f, &error), error);
    allocations = 0;
    assert_ok(solver.kind->solve(solver.state, &random.problem, &solution, &error), error);
    assert_true(allocations > 0);
    allocations = 0;
    assert_ok(solver.kind->solve(solver.state, &random.problem, &solution, &error), error);
    assert_int_equal(allocations, 0);
}

TEST(corrected_steps_allocate_nothing) {
    uint32_t seed = 1;
    OWN(SainNetwork) network;
    make_sain_network(&network, &seed, 0.1f);
    OWN(World) *world = make_pyramid();
    ContactSolver engine = make_engine(""), solver;
    run(world, &engine, 10);
    const ContactProblem *problem = world_problem(world);
    ContactSolution solution = *world_solution(world);
    assert_ok(sain_make(&solver, &network, &error), error);
    assert_ok(solver.kind->solve(solver.state, problem, &solution, &error), error);
    allocations = 0;
    assert_ok(solver.kind->solve(solver.state, problem, &solution, &error), error);
    assert_int_equal(allocations, 0);
    free_solver(&solver);
    free_solver(&engine);
}

RUN_TESTS(NULL, NULL)
