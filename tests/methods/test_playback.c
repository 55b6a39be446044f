/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What playback plays is what was recorded. */
#include "made.h"

static Trajectory *run(const Scene *scene, const char *method_text, const Launch *launch) {
    Scene launched = launch_scene(scene, launch);
    return run_by(&launched, method_text);
}

/* Of two launches recorded, which differ in x, rotation or spin, the nearer one. */
TEST(the_nearest_launch_is_played) {
    OWN(Scene) *scene = scene_named("single");
    SceneSpan *const spans[] = {&scene->bomb.x, &scene->bomb.rotation, &scene->bomb.spin};
    scene->bomb.frame = 20;
    for (int k = 0; k < 6; k++) {
        const int i = k % 2;
        Launch recorded[2];
        for (int span = 0; span < 3; span++) *spans[span] = (SceneSpan){0, span == k / 2 ? -1 : 0, span == k / 2};
        assert_ok(launches_for_training(scene, 2, recorded, &error), error);
        Launch near = recorded[i];
        near.x += 0.4f * (recorded[!i].x - near.x);
        near.rotation += 0.4f * (recorded[!i].rotation - near.rotation);
        near.spin += 0.4f * (recorded[!i].spin - near.spin);
        OWN(Trajectory) *played = run(scene, "playback:launches=2", &near);
        OWN(Trajectory) *original = run(scene, "momentum:k=100", &recorded[i]);
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
