/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trainings.h"
#include "owned.h"

#include "learning/dataset.h"

/* Frames before the bomb have none. */
TEST(poses_are_those_of_single_runs) {
    enum { LAUNCHES = 3 };
    Method method;
    Launch launches[LAUNCHES];
    LaunchRuns runs;
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 60;
    assert_ok(method_parse(&method, "engine", &error) && launches_for_training(scene, LAUNCHES, launches, &error),
              error);
    assert_ok(launch_runs_record(&runs, scene, &method, launches, LAUNCHES, NULL, &error), error);
    for (int i = 0; i < LAUNCHES; i++) {
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

TEST(too_many_are_refused) {
    LaunchRuns runs;
    OWN(Scene) *scene = scene_named("stack");
    const Method method = method_named("engine");
    const Launch own = launch_of(scene);
    scene->frames = 1000000;
    assert_refused(launch_runs_record(&runs, scene, &method, &own, 1000, NULL, &error), "at most 1024 MiB are allowed");
    launch_runs_free(&runs);
    scene->bomb.present = false;
    assert_refused(launch_runs_record(&runs, scene, &method, &own, 1, NULL, &error), "the scene has no bomb");
    launch_runs_free(&runs);
}

RUN_TESTS(NULL, NULL)
