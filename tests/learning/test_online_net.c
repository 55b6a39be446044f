/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network that learns beside the memory. */
#include "trainings.h"

#include "learning/hybrid_training.h"

#include <math.h>

/* The first ONLINE_FIRST steps make the network; trained on one step again and again, it fits it. */
TEST(a_step_that_comes_back_is_learned) {
    AskedSteps asked = {0};
    Scene *scene = scene_named("single");
    World *prefix = hybrid_prefix(scene, &error);
    assert_ok(prefix != NULL, error);
    OnlineNet *net = online_net_create(1, &error);
    assert_ok(net != NULL, error);
    for (int i = 0; i < 5; i++) {
        Launch launch = launch_of(scene);
        launch.x = (float)i / 5;
        assert_ok(launch_steps_run(scene, prefix, &launch, NULL, 3, &asked, &error), error);
    }
    assert_true(asked.count >= 5);
    double wrong, seconds, first = NAN, last = NAN;
    for (int i = 0; i < ONLINE_FIRST; i++) {
        assert_ok(online_net_learn(net, &asked.items[i % asked.count].problem, &wrong, &seconds, &error), error);
        assert_true(isnan(wrong));
    }
    for (int i = 0; i < 60; i++) {
        assert_ok(online_net_learn(net, &asked.items[0].problem, &last, &seconds, &error), error);
        assert_true(isfinite(last) && seconds >= 0);
        if (i == 0) first = last;
    }
    if (!(last <= first)) fail_msg("from %g to %g m/s", first, last);
    online_net_destroy(net);
    asked_steps_free(&asked);
    world_destroy(prefix);
    scene_destroy(scene);
}

RUN_TESTS(NULL, NULL)
