/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches whose bomb would start inside a body are refused, where the bodies are when it is added. */
#include "made.h"
#include "runs/launch_check.h"
#include "runs/runs.h"
#include "runs/trajectory.h"

#include <glob.h>

/* A box of 1 m that begins 2 m above the ground and falls; the bomb appears beside or in it. */
static const char falling[] = "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 100\nbodies:\n"
                              "  - {static: true, size: [100, 20], position: [0, -10]}\n"
                              "  - {mass: 1, size: [1, 1], position: [0, 2.5]}\n"
                              "bomb: {x: {from: -4, to: 4, value: 3}, y: 0.75, size: [1, 1], mass: 5, frame: 60}\n";

static Scene *read_scene(const char *text, const char *more) {
    const char *all = printed("%s%s", text, more);
    return scene_from(write_bytes(temporary_path("scene.yaml"), all, strlen(all)));
}

TEST(bodies_are_where_they_are_when_the_bomb_is_added) {
    OWN(Scene) *scene = read_scene(falling, "");
    Launch launch = launch_of(scene);
    launch.x = 0.6f;
    launch.frame = 1; /* the box is still above */
    assert_ok(launches_check(scene, &launch, 1, &error), error);
    launch.frame = 60; /* it lies on the ground, in the slop */
    assert_refused(launches_check(scene, &launch, 1, &error),
                   "scene: error: the launch at x = 0.6 m, rotation 0 rad: the bomb would start 0.4 m "
                   "inside body 1 in frame 60, more than the slop of 0.01 m; launch it elsewhere, or "
                   "write 'overlaps: allowed' in the scene; free x: -4 to -0.99, 0.99 to 4");
}

/* The first launch that is refused is named by its place in the list, in whatever order their frames come. */
TEST(the_launch_is_named) {
    OWN(Scene) *scene = read_scene(falling, "");
    const Launch own = launch_of(scene);
    Launch launches[] = {own, own, own, own};
    launches[0].x = 0, launches[0].frame = 2; /* still below the box */
    launches[1].x = 1.2f, launches[1].frame = 70;
    launches[2].x = -0.5f, launches[2].frame = 60;
    assert_refused(launches_check(scene, launches, 4, &error), "launch 3 at x = -0.5 m");
    error = (Error){0};
    launches[2].x = -1;
    assert_ok(launches_check(scene, launches, 4, &error), error);
    launches[3].rotation = 0.7f; /* turned, its corner reaches into the box */
    launches[3].x = 1.1f;
    assert_refused(launches_check(scene, launches, 4, &error), "launch 4 at x = 1.1 m, rotation 0.7 rad",
                   "; free x, at any rotation: -4 to -1.2, 1.2 to 4");
}

TEST(a_scene_may_allow_it) {
    OWN(Scene) *scene = read_scene(falling, "overlaps: allowed\n");
    Launch launch = launch_of(scene);
    launch.x = 0;
    assert_ok(launches_check(scene, &launch, 1, &error), error);
}

static Trajectory *run(const char *method_text, float x, Error *error) {
    OWN(Scene) *scene = read_scene(falling, "");
    Method method;
    scene->bomb.x.value = x;
    assert_ok(method_parse(&method, method_text, error), *error);
    Trajectory *trajectory = simulate(scene, &method, NULL, error);
    return trajectory;
}

TEST(runs_are_refused_by_any_method) {
    static const char *const methods[] = {"engine", "momentum", "interior"};
    for (int i = 0; i < 3; i++) {
        assert_refused(run(methods[i], 0.3f, &error), "the bomb would start 0.7 m inside body 1 in frame 60");
        OWN(Trajectory) *free_run = run(methods[i], 1.5f, (error = (Error){0}, &error));
        assert_ok(free_run != NULL, error);
    }
}

/* Training and scoring launches, and the launch of a single run. */
static void check_shipped(const char *path) {
    Error error = {0};
    OWN(Scene) *scene = scene_from(path);
    enum { COUNT = LAUNCH_GRID };
    Launch launches[2 * COUNT + 1];
    if (scene->bomb.present) {
        launches[0] = launch_of(scene);
        int count = 1;
        if (launch_has_family(scene)) {
            assert_ok(launches_for_training(scene, COUNT, launches + 1, &error), error);
            assert_ok(launches_for_scoring(scene, COUNT, launches + 1 + COUNT, &error), error);
            count += 2 * COUNT;
        }
        assert_ok(launches_check(scene, launches, count, &error), error);
    }
}

TEST(shipped_scenes_have_room_for_their_launches) {
    static const char *const folders[] = {"", "families/", "stability/", "templates/"};
    for (int i = 0; i < 4; i++) {
        glob_t found;
        assert_int_equal(glob(printed(SOURCE_DIR "/scenes/%s*.yaml", folders[i]), 0, NULL, &found), 0);
        for (size_t k = 0; k < found.gl_pathc; k++) check_shipped(found.gl_pathv[k]);
        globfree(&found);
    }
}

/* A bomb that falls straight down touches the box of 1 m at x = 0 if its own half metre and the box's reach so far. */
TEST(launches_that_strike_nothing_are_found) {
    OWN(Scene) *scene = read_scene(falling, "");
    LaunchMisses misses;
    Launch tried[LAUNCH_TRIES];
    int beside = 0, touch;
    scene->bomb.y = 3;
    assert_ok(launches_for_training(scene, LAUNCH_TRIES, tried, &error), error);
    for (int i = 0; i < LAUNCH_TRIES; i++) beside += fabsf(tried[i].x) > 1;
    assert_ok(launches_find_misses(scene, &misses, &error), error);
    assert_int_equal(misses.tried, LAUNCH_TRIES);
    assert_int_equal(misses.missed, beside);
    assert_int_equal(misses.span_count, 2);
    assert_near(misses.spans[0].from, tried[0].x, 0);
    assert_true(misses.spans[0].to < -1 && misses.spans[0].to > -1.2);
    assert_true(misses.spans[1].from > 1 && misses.spans[1].from < 1.2);
    assert_near(misses.spans[1].to, tried[LAUNCH_TRIES - 1].x, 0);
    /* From its lower face at 2.5 m to the box's upper one at 1 m: 0.5 (10 m/s^2) (0.548 s)^2, 33 steps. */
    Scene launched = launch_scene(scene, &(Launch){.x = 0, .mass = 5, .frame = 60});
    assert_ok(launch_find_touch(&launched, "engine", &touch, &error), error);
    assert_in_range(touch, 60 + 32, 60 + 35);
    launched.frames = 60 + 30; /* the run ends before */
    assert_ok(launch_find_touch(&launched, "engine", &touch, &error), error);
    assert_int_equal(touch, 0);
    assert_ok(scene_check_strike(scene, &error), error);
    scene->bomb.x.from = scene->bomb.x.to = 3; /* one launch */
    assert_refused(scene_check_strike(scene, &error), "the bomb strikes no box (x = 3 m): there is no impact to study");
    error = (Error){0};
    assert_ok(launches_find_misses(scene, &misses, &error), error);
    assert_true(misses.tried == 1 && misses.missed == 1);
    scene->frames = SCENE_MAX_FRAMES; /* would take long */
    assert_ok(launches_find_misses(scene, &misses, &error), error);
    assert_true(misses.tried == 0 && misses.missed == 0);
}

RUN_TESTS(NULL, NULL)
