/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which steps of a scene's launches are recorded, and with what solution; the poses of launches. */
#include "impacts.h"
#include "owned.h"

#include <omp.h>

enum { LAUNCHES = 6 };

/* Two contact problems that are equal to the bit. */
static void assert_equal_problems(const ContactProblem *one, const ContactProblem *two) {
    assert_int_equal(one->body_count, two->body_count);
    assert_int_equal(one->contact_count, two->contact_count);
    assert_int_equal(one->bomb, two->bomb);
    assert_true(one->dt == two->dt);
    assert_memory_equal(one->bodies, two->bodies, (size_t)one->body_count * sizeof *one->bodies);
    assert_memory_equal(one->contacts, two->contacts, (size_t)one->contact_count * sizeof *one->contacts);
}

/* In the order of launch and step, for any number of threads. */
TEST(steps_are_appended_in_order_with_the_solution_of_the_reference) {
    const int threads = omp_get_max_threads();
    OWN(RecordedSteps) steps = {0};
    OWN(Reference) reference = {0};
    omp_set_num_threads(1);
    record_impacts(&steps, LAUNCHES, 0);
    const size_t count = steps.count;
    omp_set_num_threads(2);
    record_impacts(&steps, LAUNCHES, 100);
    omp_set_num_threads(threads);
    assert_true(count > 2 * LAUNCHES);
    assert_int_equal(steps.count, 2 * count);
    for (size_t i = 0; i < steps.count; i++) {
        const RecordedStep *step = &steps.items[i];
        const int first = i < count ? 0 : 100;
        assert_in_range(step->launch, first, first + LAUNCHES - 1);
        assert_in_range(step->since, 0, IMPACT_STEPS - 1);
        assert_true(step->impact);
        assert_equal_problems(&step->problem, &steps.items[i % count].problem);
        assert_ok(reference_solve(&reference, &step->problem, NULL, &error), error);
        assert_memory_equal(step->velocities, reference.velocities,
                            (size_t)step->problem.body_count * sizeof *step->velocities);
        for (int k = 0; k < step->problem.contact_count; k++) {
            assert_true(step->impulses[k].normal == (float)reference.impulses[k].normal);
            assert_true(step->impulses[k].tangent == (float)reference.impulses[k].tangent);
        }
        assert_true(i == 0 || step[-1].launch < step->launch ||
                    (step[-1].launch == step->launch && step[-1].since < step->since));
    }
}

static bool bomb_touches(const ContactProblem *problem) {
    bool touches = false;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const int other = contact->a == problem->bomb ? contact->b : contact->a;
        touches |= (contact->a == problem->bomb || contact->b == problem->bomb) && problem->bodies[other].inv_mass > 0;
    }
    return touches;
}

/* A separate run: what is recorded is exactly the steps from the first touch whose residual reaches the gate. */
static size_t check_launch(const Scene *scene, const ContactSolver *solver, const RecordedStep *steps) {
    Error error = {0};
    Scene quiet = *scene;
    quiet.bomb.present = false;
    OWN(World) *world = world_of(&quiet);
    size_t found = 0;
    for (int frame = 0, since = -1; since < IMPACT_STEPS - 1 && frame <= scene->frames; frame++) {
        if (frame == scene->bomb.frame) assert_ok(scene_add_bomb(scene, world, &error), error);
        assert_ok(world_step(world, solver->kind->solve, solver->state, scene->dt, &error), error);
        const ContactProblem *problem = world_problem(world);
        if (since >= 0 || (problem->bomb >= 0 && bomb_touches(problem))) since++;
        if (since < 0 || residual_of(problem) < (double)impact_gate) continue;
        assert_int_equal(steps[found].since, since);
        assert_equal_problems(&steps[found++].problem, problem);
    }
    return found;
}

TEST(impacts_are_the_steps_with_a_large_residual) {
    OWN(RecordedSteps) steps = {0};
    ContactSolver solver;
    OWN(Scene) *scene = scene_named("stack");
    Launch launches[LAUNCHES];
    record_impacts(&steps, LAUNCHES, 0);
    throw_over_grid(scene, LAUNCHES, launches);
    assert_ok(make_momentum(NULL, 0, &solver, &error), error);
    size_t done = 0;
    for (int i = 0; i < LAUNCHES; i++) {
        const Scene launched = launch_scene(scene, &launches[i]);
        done += check_launch(&launched, &solver, steps.items + done);
    }
    assert_int_equal(done, steps.count);
    assert_true(done < LAUNCHES * IMPACT_STEPS);
    solver_destroy(&solver);
}

static bool no_solver(void *context, int i, ContactSolver *solver, Error *error) {
    (void)context, (void)i, (void)solver;
    return error_input(error, "solver", "not available");
}

TEST(what_cannot_run_is_an_error) {
    OWN(Scene) *scene = scene_named("stack");
    const Launch launch = launch_of(scene);
    RecordedSteps steps = {0};
    LaunchWatch watch = {
        .scene = scene, .launches = &launch, .count = 1, .impact_frames = 1, .make = no_solver, .see = keep_impact};
    assert_refused(launches_observe(&watch, &steps, NULL, &error), "not available");
    /* A state that is infinite ends a launch only where it may fail. */
    scene->gravity.y = -INFINITY;
    watch.make = make_momentum;
    watch.from_start = true;
    error = (Error){0};
    assert_refused(launches_observe(&watch, &steps, NULL, &error), "is NaN or infinite",
                   "in step 1 of scene stack, launch 0");
    watch.may_fail = true;
    error = (Error){0};
    assert_ok(launches_observe(&watch, &steps, NULL, &error), error);
    assert_int_equal(steps.count, 0);
    recorded_steps_free(&steps);
}

/* Frames before the bomb have none. */
TEST(poses_are_those_of_single_runs) {
    enum { RUNS = 3 };
    Method method;
    Launch launches[RUNS];
    LaunchRuns runs;
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 60;
    assert_ok(method_parse(&method, "engine", &error) && launches_for_training(scene, RUNS, launches, &error), error);
    assert_ok(launch_runs_record(&runs, scene, &method, launches, RUNS, NULL, &error), error);
    for (int i = 0; i < RUNS; i++) {
        const Scene launched = launch_scene(scene, &launches[i]);
        OWN(Trajectory) *run = run_with(&launched, &method);
        assert_int_equal(runs.bodies, run->bodies);
        assert_int_equal(runs.frames, run->frames);
        for (int frame = 0; frame < run->frames; frame++)
            for (int body = 0; body < run->bodies; body++) {
                const BodyPose pose = launch_runs_frame(&runs, i, frame)[body];
                const int at = frame * run->bodies + body;
                assert_true(isfinite(pose.angle) == trajectory_has(run, frame, body));
                if (!isfinite(pose.angle)) continue;
                assert_memory_equal(&pose.position, &run->position[at], sizeof pose.position);
                assert_memory_equal(&pose.angle, &run->angle[at], sizeof pose.angle);
            }
    }
    launch_runs_free(&runs);
}

TEST(too_many_poses_are_refused) {
    LaunchRuns runs;
    OWN(Scene) *scene = scene_named("stack");
    const Method method = method_named("engine");
    const Launch own = launch_of(scene);
    scene->frames = 1000000;
    assert_refused(launch_runs_record(&runs, scene, &method, &own, 1000, NULL, &error), "at most 1024 MiB are allowed");
    launch_runs_free(&runs);
    scene->bomb.present = false;
    error = (Error){0};
    assert_refused(launch_runs_record(&runs, scene, &method, &own, 1, NULL, &error), "the scene has no bomb");
    launch_runs_free(&runs);
}

RUN_TESTS(NULL, NULL)
