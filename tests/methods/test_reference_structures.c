/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference over whole runs: it converges where masses differ by a million, and gives no energy where it cannot.
   tests/deep/run structures runs a thousand of these. */
#include "made.h"
#include "random_structures.h"
#include "reference_worlds.h"
#include "sanitized.h"

typedef struct Converged {
    Reference reference;
    int steps, failed;
    double gained; /* J: the most that a step's impulses added to the kinetic energy */
} Converged;

static double kinetic(const ContactProblem *problem, const BodyVelocity *velocities) {
    double sum = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const Vec2 v = velocities != NULL ? velocities[i].linear : body->velocity;
        const double spin = (double)(velocities != NULL ? velocities[i].angular : body->angular_velocity);
        if (body->inv_mass > 0) sum += (double)vec2_dot(v, v) / (double)body->inv_mass;
        if (body->inv_inertia > 0) sum += spin * spin / (double)body->inv_inertia;
    }
    return sum / 2;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Converged *run = state;
    if (!reference_solve(&run->reference, problem, NULL, error)) return false;
    reference_round(&run->reference, problem, solution);
    run->steps++;
    if (!(run->reference.residual <= tight)) {
        run->failed++;
        run->gained = fmax(run->gained, kinetic(problem, solution->velocities) - kinetic(problem, NULL));
    }
    return true;
}

static Converged run_scene(const Scene *scene) {
    Error error = {0};
    Converged run = {0};
    OWN(World) *world = world_of(scene);
    for (int i = 0; i < scene->frames; i++) assert_ok(world_step(world, solve, &run, scene->dt, &error), error);
    reference_free(&run.reference);
    return run;
}

static Converged run_file(const char *name) {
    OWN(Scene) *scene = scene_from(printed(SOURCE_DIR "/tests/methods/scenes/%s.yaml", name));
    const Converged run = run_scene(scene);
    assert_int_equal(run.steps, scene->frames);
    return run;
}

TEST(masses_spread_by_a_million_converge) {
    assert_int_equal(run_file("bridge").failed, 0);
    assert_int_equal(run_file("feather").failed, 0);
}

static void assert_converges(const int *seeds, size_t count) {
    for (size_t i = 0; i < count; i++) {
        OWN(Scene) *scene = random_structure(seeds[i]);
        const int failed = run_scene(scene).failed;
        if (failed > 0) fail_msg("%s: %d steps", scene->name, failed);
    }
}

/* Structures that an attempt which gives up after two short steps leaves unsolved. */
TEST(random_structures_converge) {
    static const int seeds[] = {773, 783, 824, 828, 850, 873, 886, 894, 910, 970};
    assert_converges(seeds, sizeof seeds / sizeof *seeds);
}

/* Structures of which up to 118 steps are left where every contact is measured by its own masses. */
TEST(light_boxes_between_heavy_ones_converge) {
    static const int seeds[] = {59, 182, 254, 362, 421, 445, 471, 553, 776};
    assert_converges(seeds, sizeof seeds / sizeof *seeds);
}

/* Position correction pushes the box out between walls that its friction holds it to. */
TEST(a_step_without_a_solution_adds_no_energy) {
    const Converged run = run_file("wedge");
    assert_true(run.failed > 0);
    assert_true(run.gained <= 1e-9);
}

/* A run tells how many of its steps did not converge, and the largest residual. */
TEST(a_run_counts_steps_without_a_solution) {
    OWN(Scene) *scene = scene_from(SOURCE_DIR "/tests/methods/scenes/wedge.yaml");
    const Method method = method_named("reference");
    Fallbacks fallbacks = {0};
    assert_ok(simulate_watched(scene, &method, &(RunWatch){.fallbacks = &fallbacks}, &error), error);
    assert_int_equal(fallbacks.not_converged, run_scene(scene).failed);
    assert_true(fallbacks.residual > tight);
}

/* As they come, none chosen. */
TEST(the_first_structures_converge) {
    int failed = 0;
    for (int seed = 0; seed < 60; seed += sampled(4)) {
        OWN(Scene) *scene = random_structure(seed);
        failed += run_scene(scene).failed;
    }
    assert_int_equal(failed, 0);
}

RUN_TESTS(NULL, NULL)
