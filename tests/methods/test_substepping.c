/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small steps: what they must have in common with whole ones. */
#include "made.h"

static Trajectory *run(const char *scene_name, const char *method_text, int frames) {
    OWN(Scene) *scene = scene_named(scene_name);
    if (frames > 0) scene->frames = frames;
    Trajectory *trajectory = run_by(scene, method_text);
    return trajectory;
}

TEST(one_small_step_is_the_whole_step) {
    OWN(Trajectory) *whole = run("stack", "engine:k=10", 0), *small = run("stack", "substepping:substeps=1,k=10", 0);
    for (int i = 0; i < whole->frames; i++)
        assert_true(trajectory_frame_hash(whole, i) == trajectory_frame_hash(small, i));
}

/* n small steps of semi-implicit Euler: the fall is g t^2 / 2 (1 + 1 / (60 n t)). */
TEST(a_box_falls_by_its_small_steps) {
    OWN(Trajectory) *run4 = run("single", "substepping:substeps=4", 30);
    const double t = 0.5, fall = 0.5 * 10 * t * t * (1 + 1 / (60 * 4 * t));
    assert_near(run4->position[30 * run4->bodies + 1].y, 4 - fall, 1e-4);
}

/* The impulses stored are those of a whole step: at rest m g dt. The bomb is away by then. */
TEST(small_steps_carry_the_weight) {
    OWN(Trajectory) *rest = run("single", "substepping:substeps=10", 300);
    double ground = 0;
    for (int64_t i = rest->contact_start[299]; i < rest->contact_start[300]; i++)
        if (rest->contacts[i].b == 1) ground += (double)rest->contacts[i].normal_impulse;
    assert_near(ground, 200 * 10.0 / 60, 1e-2);
}

RUN_TESTS(NULL, NULL)
