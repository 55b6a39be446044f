/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

TEST(a_trajectory_says_what_it_is) {
    OWN(Scene) *scene = scene_named("single");
    scene->frames = 60;
    OWN(Trajectory) *trajectory = run_by(scene, "engine:k=3");
    assert_string_equal(trajectory->scene, "single");
    assert_string_equal(trajectory->method, "engine:k=3");
    assert_true(trajectory->scene_hash == scene_hash(scene));
    assert_int_equal(trajectory->frames, 61);
    assert_int_equal(trajectory->bodies, 3);
    assert_int_equal(trajectory->bomb, 2);
    assert_true(trajectory->fixed[0] && !trajectory->fixed[1]);
    assert_near(trajectory->size[0].x, 100, 0);
    assert_near(trajectory->dt, 1.0f / 60.0f, 0);
    /* The box stands 3.5 m above the ground: contacts begin when it lands or the bomb hits it, and are numbered. */
    int64_t contacts = trajectory->contact_start[61];
    assert_true(contacts > 20);
    assert_int_equal(trajectory->contact_start[1], 0);
    assert_int_equal(trajectory->contact_start[20], 0);
    for (int64_t i = 0; i < contacts; i++) assert_true(trajectory->contacts[i].a < trajectory->contacts[i].b);
}

/* Put in after step 10, so it is in frame 10 and has not moved there yet. */
TEST(the_bomb_comes_after_the_step_it_is_told_to) {
    OWN(Scene) *scene = scene_named("single");
    scene->frames = 20;
    scene->bomb.frame = 10;
    Trajectory *trajectory = run_by(scene, "engine");
    assert_false(trajectory_has(trajectory, 9, 2));
    assert_true(trajectory_has(trajectory, 10, 2));
    assert_near(trajectory->position[10 * 3 + 2].y, 15, 0);
    assert_true(trajectory->position[11 * 3 + 2].y < 15);
    trajectory_destroy(trajectory);
    /* One that comes after the end is not in the run at all. */
    scene->frames = 9;
    trajectory = run_by(scene, "engine");
    assert_int_equal(trajectory->bodies, 2);
    assert_int_equal(trajectory->bomb, -1);
    trajectory_destroy(trajectory);
}

static Scene *read_top_removed(void) {
    Scene *scene = scene_named("stability/top_removed");
    assert_int_equal(scene->last_body_until, 600);
    scene->last_body_until = 30;
    scene->frames = 60;
    return scene;
}

/* Taken out after step 30, so it is not in frame 30, though step 30 had its contacts; a file tells the same. */
TEST(the_last_body_goes_after_the_step_it_is_told_to) {
    OWN(Scene) *scene = read_top_removed();
    OWN(Trajectory) *trajectory = run_by(scene, "engine");
    assert_int_equal(trajectory->bodies, 12);
    for (int frame = 0; frame <= 60; frame++) assert_int_equal(trajectory_has(trajectory, frame, 11), frame < 30);
    for (int step = 1; step <= 60; step++) {
        bool touched = false;
        for (int64_t i = trajectory->contact_start[step]; i < trajectory->contact_start[step + 1]; i++)
            touched |= trajectory->contacts[i].b == 11;
        assert_int_equal(touched, step <= 30);
    }
    const char *path = temporary_path("gone.npz");
    assert_ok(trajectory_write(trajectory, path, &error), error);
    OWN(Trajectory) *read = trajectory_of(path);
    assert_same_run(trajectory, read);
}

/* One that stands aside changes no bit of the others, neither while it is there nor when it goes. */
TEST(a_body_that_touches_none_of_the_others_changes_none) {
    OWN(Scene) *scene = read_top_removed();
    scene->bodies[11].position = vec2(30, 0.5f);
    OWN(Trajectory) *with = run_by(scene, "engine");
    scene->body_count = 11;
    scene->last_body_until = 0;
    OWN(Trajectory) *without = run_by(scene, "engine");
    assert_true(trajectory_has(with, 29, 11) && !trajectory_has(with, 30, 11));
    for (int frame = 0; frame <= 60; frame++) {
        assert_memory_equal(&with->position[frame * 12], &without->position[frame * 11], 11 * sizeof(Vec2));
        assert_memory_equal(&with->angle[frame * 12], &without->angle[frame * 11], 11 * sizeof(float));
        assert_memory_equal(&with->velocity[frame * 12], &without->velocity[frame * 11], 11 * sizeof(Vec2));
    }
}

static bool count_step(void *context, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    int *steps = context;
    assert_int_equal(frame, ++*steps);
    assert_int_equal(problem->body_count, 3);
    assert_int_equal(problem->bomb, 2);
    return frame < 7 || error_input(error, "observer", "enough");
}

TEST(an_observer_sees_every_step_and_may_end_the_run) {
    OWN(Scene) *scene = scene_named("single");
    int steps = 0;
    StepObserver observer = {count_step, &steps};
    const Method method = method_named("engine");
    assert_refused(simulate_observed(scene, &method, &observer, &error), "observer: error: enough");
    assert_int_equal(steps, 7);
}

static bool stop(void *context, double done, double total) {
    (void)context, (void)total;
    return done < 5;
}

TEST(a_run_that_cannot_go_on_says_why) {
    OWN(Scene) *scene = scene_named("single");
    Method method = method_named("engine");
    assert_null(simulate(scene, &method, &(Progress){stop, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "single: error: stopped after step 5 of 300");

    error = (Error){0};
    scene->bomb.velocity_from_position = false;
    scene->bomb.velocity = vec2(3e38f, 3e38f);
    scene->dt = 100;
    assert_refused(simulate(scene, &method, NULL, &error), "the state of body 2 is NaN or infinite",
                   "in step 1 of scene single");

    error = (Error){0};
    scene->network_count = 0;
    assert_ok(method_parse(&method, "pair-net", &error), error);
    assert_refused(simulate(scene, &method, NULL, &error), "the scene names no network");
}

TEST(methods_are_found_by_name) {
    Method method;
    int count = 0;
    for (; method_kinds[count].description != NULL; count++) {
        if (method_kinds[count].description->external) continue; /* the program is missing */
        assert_ok(method_parse(&method, method_kinds[count].description->name, &error), error);
        assert_ptr_equal(method.kind, &method_kinds[count]);
    }
    assert_true(count > 2);
    assert_refused(method_parse(&method, "engin", &error),
                   "method: error: 'engin' is not a method; did you mean 'engine'?");
    error = (Error){0};
    char text[METHOD_TEXT_SIZE + 1];
    memset(text, 'x', METHOD_TEXT_SIZE);
    text[METHOD_TEXT_SIZE] = '\0';
    assert_refused(method_parse(&method, text, &error), "at most");
}

RUN_TESTS(NULL, NULL)
