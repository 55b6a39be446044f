/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run compared with a shifted one. */
#include "made.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/trajectory.h"

OWNED_VALUE(Chaos, chaos_free)

static const char *write_scene(const char *bodies_and_bomb) {
    const char *path = temporary_path("scene.yaml");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 60\nbodies:\n%s", bodies_and_bomb);
    fclose(file);
    return path;
}

static Trajectory *run_scene(const char *path, const char *text) {
    OWN(Scene) *scene = scene_from(path);
    Trajectory *run = run_by(scene, text);
    return run;
}

static const char falling[] = "  - {size: [1, 1], position: [3, 50], mass: 1, friction: 0}\n"
                              "  - {static: true, size: [100, 20], position: [0, -10], friction: 0.2}\n";
static const char bomb[] = "bomb: {x: 0.001, y: 100, frame: 20, size: [1, 1], mass: 50, friction: 0.2, velocity: "
                           "{times_position: 15}}\n";

/* Only the position is shifted and nothing is touched: the distance is the shift, from the body's first frame. If the
   velocity of an aimed bomb were shifted too, its distance would grow by 15e-6 m/s. */
TEST(a_shift_in_free_flight_is_constant) {
    char text[1024];
    for (int with_bomb = 0; with_bomb < 2; with_bomb++) {
        snprintf(text, sizeof text, "%s%s", falling, with_bomb ? bomb : "");
        const char *path = write_scene(text);
        OWN(Trajectory) *run = run_scene(path, "engine");
        int body = chaos_body(run, -1, -1);
        assert_int_equal(body, with_bomb ? 2 : 0);
        OWN(Chaos) chaos;
        assert_ok(chaos_run(&chaos, path, run, body, 50, NULL, &error), error);
        assert_true(chaos.body == body && chaos.rerun_differs == -1 && chaos.frames == 50);
        assert_near(chaos.shift, 1e-6, 0.2e-6);
        for (int frame = 0; frame < 50; frame++)
            assert_near(chaos.distance[frame], with_bomb && frame < 20 ? 0 : chaos.shift, 1e-7);
    }
}

/* At a position where one ulp is 0.0625 m. */
TEST(a_shift_is_at_least_one_float) {
    const char *path = write_scene("  - {size: [1, 1], position: [600000, 50], mass: 1, friction: 0}\n");
    OWN(Trajectory) *run = run_scene(path, "engine");
    OWN(Chaos) chaos;
    assert_ok(chaos_run(&chaos, path, run, 0, 10, NULL, &error), error);
    assert_true(chaos.shift == 0.0625 && chaos.distance[9] == 0.0625);
}

/* scenes/stack.yaml: the bomb hits in step 41; body 1 touches the ground from step 4. */
TEST(a_bomb_that_has_not_hit_is_not_shifted) {
    OWN(Trajectory) *run = run_scene(SOURCE_DIR "/scenes/stack.yaml", "engine");
    assert_int_equal(run->bomb, 11);
    int hit = 0;
    for (int step = 1; hit == 0; step++)
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++)
            if (run->contacts[i].b == run->bomb) hit = step;
    assert_int_equal(chaos_body(run, 1, hit - 1), 1);
    assert_int_equal(chaos_body(run, 1, hit), 11);
    assert_int_equal(chaos_body(run, 0, hit - 1), 11); /* the ground cannot be shifted */
    assert_int_equal(chaos_body(run, -1, -1), 11);
    run->bomb = -1;
    assert_int_equal(chaos_body(run, 1, hit - 1), 11);
    for (int body = 0; body < run->bodies; body++) run->fixed[body] = 1;
    assert_int_equal(chaos_body(run, 1, hit - 1), -1);
}

/* The distances are those between the two trajectories. */
TEST(distances_are_those_of_the_trajectories) {
    const char *path = SOURCE_DIR "/scenes/stack.yaml";
    OWN(Trajectory) *run = run_scene(path, "momentum:k=5");
    OWN(Scene) *scene = scene_from(path);
    scene->bodies[10].position.x = 1e-6F;
    OWN(Trajectory) *shifted = run_by(scene, "momentum:k=5");
    OWN(Chaos) chaos;
    assert_ok(chaos_run(&chaos, path, run, 10, run->frames, NULL, &error), error);
    for (int frame = 0; frame < run->frames; frame++)
        assert_true(chaos.distance[frame] == trajectory_distance(run, shifted, frame));
}

static void expect_refused(const Trajectory *run, const char *path, int frames, const char *reason) {
    Error error = {0};
    Chaos chaos;
    assert_refused(chaos_run(&chaos, path, run, 1, frames, NULL, &error), reason);
}

TEST(other_scenes_and_runs_are_detected) {
    const char *path = SOURCE_DIR "/scenes/stack.yaml";
    OWN(Trajectory) *run = run_scene(path, "engine");
    expect_refused(run, SOURCE_DIR "/scenes/single.yaml", 20, "single.yaml: error: is not the scene of the run");
    expect_refused(run, path, SCENE_MAX_FRAMES + 2, "can run at most");
    strcpy(run->method, "engine:network=none");
    expect_refused(run, path, 20, "network");
    strcpy(run->method, "pair-net:network=nowhere.npz");
    expect_refused(run, path, 20, "nowhere.npz");
    strcpy(run->method, "engine:k=1");
    Chaos chaos;
    assert_ok(chaos_run(&chaos, path, run, 1, 20, NULL, &error), error);
    assert_true(chaos.rerun_differs > 0);
    chaos_free(&chaos);
    run->bodies = 3; /* a forged run with the hash of the scene */
    run->bomb = 2;
    expect_refused(run, path, 20, "bodies: 12 and 3");
}

static bool stop_late(void *context, double done, double total) {
    (void)context;
    return done < 0.75 * total;
}

/* A stop must not be taken for a NaN or infinite state. */
TEST(a_stop_is_an_error) {
    const char *path = SOURCE_DIR "/scenes/stack.yaml";
    OWN(Trajectory) *run = run_scene(path, "engine");
    Chaos chaos;
    assert_false(chaos_run(&chaos, path, run, 1, 101, &(Progress){stop_late, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped after step 51 of 100");
}

RUN_TESTS(NULL, NULL)
