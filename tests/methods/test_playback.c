/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What playback plays is what was recorded. */
#include "made.h"

static Trajectory *run(const char *method_text, float x, int frame) {
    OWN(Scene) *scene = scene_named("single");
    scene->bomb.frame = 20;
    Launch launch = launch_of(scene);
    launch.x = x;
    launch.frame = frame;
    Scene launched = launch_scene(scene, &launch);
    Trajectory *trajectory = run_by(&launched, method_text);
    return trajectory;
}

/* Of two launches recorded, x = -2.5 and 2.5 m, the nearer one. */
TEST(the_nearest_launch_is_played) {
    Launch recorded[2];
    Scene *scene = scene_named("single");
    assert_ok(launches_for_training(scene, 2, recorded, &error), error);
    scene_destroy(scene);
    for (int i = 0; i < 2; i++) {
        OWN(Trajectory) *played = run("playback:launches=2", recorded[i].x * 0.3f, 20);
        OWN(Trajectory) *original = run("momentum:k=100", recorded[i].x, 20);
        size_t states = (size_t)played->frames * (size_t)played->bodies;
        for (size_t s = 21 * (size_t)played->bodies; s < states; s++) {
            assert_near(played->velocity[s].x, original->velocity[s].x, 0);
            assert_near(played->angular_velocity[s], original->angular_velocity[s], 0);
        }
    }
}

TEST(a_scene_without_a_bomb_has_nothing_to_play) {
    OWN(Scene) *scene = scene_named("single");
    scene->bomb.present = false;
    Method method = method_named("playback");
    assert_refused(simulate(scene, &method, NULL, &error),
                   "playback: error: scene single has no bomb: nothing to play");
}

RUN_TESTS(NULL, NULL)
