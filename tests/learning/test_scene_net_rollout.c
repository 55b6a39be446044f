/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which steps of a scene's launches become samples. */
#include "impacts.h"
#include "owned.h"
#include "equal_problems.h"

#include "methods/residuals.h"

enum { LAUNCHES = 6 };

TEST(samples_are_appended_in_the_order_of_launch_and_step) {
    OWN(SceneNetSamples) samples = {0};
    record_impacts(&samples, LAUNCHES, 0);
    const int count = samples.count;
    record_impacts(&samples, LAUNCHES, 100);
    assert_true(count > 2 * LAUNCHES);
    assert_int_equal(samples.count, 2 * count);
    for (int i = 0; i < samples.count; i++) {
        const SceneNetSample *sample = &samples.items[i];
        const int first = i < count ? 0 : 100;
        assert_in_range(sample->launch, first, first + LAUNCHES - 1);
        assert_in_range(sample->since, 0, IMPACT_STEPS - 1);
        if (i < count) assert_equal_problems(&sample->problem, &samples.items[count + i].problem);
        if (i == 0) continue;
        assert_true(sample[-1].launch < sample->launch ||
                    (sample[-1].launch == sample->launch && sample[-1].since < sample->since));
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

/* A separate run: the samples must be exactly the steps from the first touch whose residual reaches the gate. */
static int check_launch(const Scene *scene, const ContactSolver *solver, const SceneNetSample *samples) {
    Error error = {0};
    Scene quiet = *scene;
    quiet.bomb.present = false;
    OWN(World) *world = world_of(&quiet);
    int found = 0;
    for (int frame = 0, since = -1; since < IMPACT_STEPS - 1 && frame <= scene->frames; frame++) {
        if (frame == scene->bomb.frame) assert_ok(scene_add_bomb(scene, world, &error), error);
        assert_ok(world_step(world, solver->kind->solve, solver->state, scene->dt, &error), error);
        const ContactProblem *problem = world_problem(world);
        if (since >= 0 || (problem->bomb >= 0 && bomb_touches(problem))) since++;
        if (since < 0 || residual_of(problem) < (double)impact_gate) continue;
        assert_int_equal(samples[found].since, since);
        assert_equal_problems(&samples[found++].problem, problem);
    }
    return found;
}

TEST(samples_are_the_steps_with_a_large_residual) {
    OWN(SceneNetSamples) samples = {0};
    ContactSolver solver;
    OWN(Scene) *scene = scene_named("stack");
    Launch launches[LAUNCHES];
    record_impacts(&samples, LAUNCHES, 0);
    throw_over_grid(scene, LAUNCHES, launches);
    assert_ok(make_momentum(NULL, &solver, &error), error);
    int done = 0;
    for (int i = 0; i < LAUNCHES; i++) {
        const Scene launched = launch_scene(scene, &launches[i]);
        done += check_launch(&launched, &solver, samples.items + done);
    }
    assert_int_equal(done, samples.count);
    assert_true(done < LAUNCHES * IMPACT_STEPS);
    solver.kind->destroy(solver.state);
}

static bool no_solver(void *context, ContactSolver *solver, Error *error) {
    (void)context, (void)solver;
    return error_input(error, "solver", "not available");
}

TEST(a_solver_that_cannot_be_made_is_an_error) {
    OWN(Scene) *scene = scene_named("stack");
    Launch launch = launch_of(scene);
    SceneNetSamples samples = {0};
    const SceneNetRollout rollout = {
        .scene = scene, .launches = &launch, .launch_count = 1, .steps = 1, .make_solver = no_solver};
    assert_refused(scene_net_rollout(&rollout, &samples, NULL, &error), "not available");
    assert_int_equal(samples.count, 0);
}

RUN_TESTS(NULL, NULL)
