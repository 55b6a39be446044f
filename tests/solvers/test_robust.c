/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stacks as a whole: where that is an answer, it is the converged one, and where it is none, the engine's. */
#include "consistent.h"
#include "kernels.h"

#include "solvers/forest.h"

#include "collision/uniform.h"
#include "worlds.h"

enum { TALL = 40 };

static void add_box(World *world, Vec2 position, Vec2 size, float mass, Vec2 velocity) {
    add_body(world,
             &(BodyDef){.size = size, .mass = mass, .friction = 0.4f, .position = position, .velocity = velocity});
}

static ContactProblem begin(World *world) {
    Error error = {0};
    ContactProblem problem;
    ContactSolution *ours;
    assert_ok(world_begin_step(world, world_dt, &problem, &ours, &error), error);
    return problem;
}

static ForestResult answer_to(const ContactProblem *problem) {
    Forest forest = {0};
    ForestResult answer;
    ContactSolution room = make_solution(problem);
    assert_true(forest_solve(&forest, problem, room.impulses, &answer));
    free_solution(&room);
    forest_free(&forest);
    return answer;
}

/* 40 boxes and a thousandfold one on top, cold: g dt times what is above, after one step. The sum of 40 roundings. */
static void a_stack_carries_its_weight_at_once(void **state) {
    (void)state;
    World *world = make_world();
    add_ground(world, 0.4f);
    for (int i = 0; i < TALL; i++) add_box(world, vec2(0, 0.5f + (float)i), vec2(1, 1), 1, vec2(0, 0));
    add_box(world, vec2(0, 0.5f + (float)TALL), vec2(1, 1), 1000, vec2(0, 0));
    ContactSolver robust = make_solver(&solver_robust, "k=1");
    run(world, &robust, 1);
    const ContactSolution *solution = world_solution(world);
    assert_int_equal(world_problem(world)->contact_count, 2 * (TALL + 1));
    for (int i = 0; i <= TALL; i++) {
        double weight = 10 * (double)world_dt * (1000 + TALL - i);
        assert_near(solution->impulses[2 * i].normal, weight / 2, 1e-5 * weight);
        assert_near(solution->impulses[2 * i + 1].normal, weight / 2, 1e-5 * weight);
        assert_near(solution->velocities[i + 1].linear.y, 0, 1e-6);
    }
    free_solver(&robust);
    world_destroy(world);
}

/* A table on the ground that carries three stacks, all coming down at once, the boxes in each other by up to 3 cm and
   not quite level, made in an order that is none: branches, two biases a pair, both sides of it. */
static World *make_trees(uint32_t *seed) {
    World *world = make_world();
    const Vec2 falling = vec2(uniform(seed, -0.05f, 0.05f), uniform(seed, -2, -1));
    float tops[3] = {0.995f, 0.995f, 0.995f};
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 3; column++) {
            float depth = uniform(seed, 0.008f, 0.03f), x = 3 * (float)(column - 1) + uniform(seed, -0.1f, 0.1f);
            add_body(world, &(BodyDef){.size = {1.2f, 1},
                                       .mass = uniform(seed, 1, 20),
                                       .friction = 0.4f,
                                       .position = {x, tops[column] + 0.5f - depth},
                                       .angle = uniform(seed, -0.004f, 0.004f),
                                       .velocity = falling});
            tops[column] += 1 - depth;
        }
    add_box(world, vec2(0, 0.495f), vec2(9, 1), 5, falling);
    add_ground(world, 0.4f);
    return world;
}

static void trees_are_solved_as_sweeps_would_in_the_end(void **state) {
    (void)state;
    uint32_t seed = 7;
    int whole = 0;
    for (int trial = 0; trial < 20; trial++) {
        World *world = make_trees(&seed);
        const ContactProblem problem = begin(world);
        ContactSolution found = make_solution(&problem), converged = make_solution(&problem);
        solve_with(&solver_robust, "k=1", &problem, &found);
        solve_with(&solver_reference, "", &problem, &converged);
        assert_consistent(&problem, &found);
        if (answer_to(&problem) == FOREST_WHOLE) {
            whole++;
            for (int i = 0; i < problem.contact_count; i++) {
                assert_true(found.impulses[i].normal >= 0);
                assert_true(fabsf(found.impulses[i].tangent) <=
                            problem.contacts[i].friction * found.impulses[i].normal);
            }
            for (int i = 0; i < problem.body_count; i++) {
                assert_near(found.velocities[i].linear.x, converged.velocities[i].linear.x, 1e-4);
                assert_near(found.velocities[i].linear.y, converged.velocities[i].linear.y, 1e-4);
                assert_near(found.velocities[i].angular, converged.velocities[i].angular, 1e-4);
            }
        }
        free_solution(&found);
        free_solution(&converged);
        world_destroy(world);
    }
    assert_true(whole >= 10);
}

/* A beam on two posts, and a box on it. */
static void what_stands_on_a_loop_is_the_engines(void **state) {
    (void)state;
    World *worlds[2];
    const ContactSolverKind *const kinds[] = {&solver_engine, &solver_robust};
    for (int k = 0; k < 2; k++) {
        worlds[k] = make_world();
        add_ground(worlds[k], 0.4f);
        add_box(worlds[k], vec2(-1, 0.5f), vec2(1, 1), 1, vec2(0, 0));
        add_box(worlds[k], vec2(1, 0.5f), vec2(1, 1), 2, vec2(0, 0));
        add_box(worlds[k], vec2(0, 1.5f), vec2(3, 1), 3, vec2(0.2f, 0));
        add_box(worlds[k], vec2(0.3f, 2.5f), vec2(1, 1), 4, vec2(0, 0));
        ContactSolver solver = make_solver(kinds[k], "");
        run(worlds[k], &solver, 120);
        free_solver(&solver);
        assert_int_equal(world_problem(worlds[k])->contact_count, 10);
        assert_int_equal(answer_to(world_problem(worlds[k])), FOREST_NONE);
    }
    assert_memory_equal(world_bodies(worlds[0]), world_bodies(worlds[1]), 5 * sizeof(Body));
    for (int k = 0; k < 2; k++) world_destroy(worlds[k]);
}

/* How low a box of 1 m is after 3 s that stands on another, shifted to its side. */
static float height_of_overhang(float shift) {
    World *world = make_world();
    add_ground(world, 0.4f);
    add_box(world, vec2(0, 0.5f), vec2(1, 1), 10, vec2(0, 0));
    add_box(world, vec2(shift, 1.5f), vec2(1, 1), 1, vec2(0, 0));
    ContactSolver robust = make_solver(&solver_robust, "");
    run(world, &robust, 180);
    float height = world_bodies(world)[2].position.y;
    free_solver(&robust);
    world_destroy(world);
    return height;
}

/* No more is held than can stand: the edge is half a metre out. */
static void a_box_tips_when_its_middle_is_past_the_edge(void **state) {
    (void)state;
    assert_near(height_of_overhang(0.48f), 1.49f, 0.02f);
    assert_true(height_of_overhang(0.52f) < 1.2f);
}

/* Two points of one pair that do not push the same way, as a problem from a file may have them, tie other numbers than the
   passes count on. */
static void points_with_two_normals_are_the_engines(void **state) {
    (void)state;
    World *world = make_world();
    add_ground(world, 0.4f);
    add_box(world, vec2(0, 0.5f), vec2(1, 1), 1, vec2(0, -1));
    ContactProblem problem = begin(world);
    ContactPoint contacts[2];
    assert_int_equal(problem.contact_count, 2);
    memcpy(contacts, problem.contacts, sizeof contacts);
    problem.contacts = contacts;
    assert_int_equal(answer_to(&problem), FOREST_WHOLE);
    contacts[1].normal = vec2(0.6f, 0.8f);
    assert_int_equal(answer_to(&problem), FOREST_NONE);
    world_destroy(world);
}

/* Neither a box on its corner nor one on another in the air. */
static void what_is_not_grounded_is_the_engines(void **state) {
    (void)state;
    World *world = make_world();
    add_ground(world, 0.4f);
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .position = {0, 0.6f}, .angle = 0.3f});
    add_box(world, vec2(5, 5), vec2(1, 1), 1, vec2(0, 0));
    add_box(world, vec2(5, 5.99f), vec2(1, 1), 1, vec2(0, -1));
    const ContactProblem problem = begin(world);
    assert_int_equal(problem.contact_count, 3);
    assert_int_equal(answer_to(&problem), FOREST_NONE);
    world_destroy(world);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_not_grounded_is_the_engines),
                                       cmocka_unit_test(a_stack_carries_its_weight_at_once),
                                       cmocka_unit_test(trees_are_solved_as_sweeps_would_in_the_end),
                                       cmocka_unit_test(what_stands_on_a_loop_is_the_engines),
                                       cmocka_unit_test(a_box_tips_when_its_middle_is_past_the_edge),
                                       cmocka_unit_test(points_with_two_normals_are_the_engines)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
