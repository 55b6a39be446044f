/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of gns: runs beside the teacher's, and verdicts from made-up tables. */
#include "made.h"
#include "tables.h"

#include "paper/paper_internal.h"

/* Without its network gns falls: as its teacher until something touches, and then through the ground, g t^2 / 2. */
TEST(without_its_network_boxes_fall_away) {
    OWN(Scene) *scene = scene_named("single");
    GnsRollout rollout;
    assert_ok(gns_rollout_run(&rollout, scene, "none.npz", "net=off", &error), error);
    assert_int_equal(rollout.boxes, 2);
    assert_near(rollout.error[0], 0, 1e-4);
    assert_in_range(rollout.error[GNS_TIMES - 1], 100, 300);
    assert_near(rollout.shape[GNS_TIMES - 1], 0, 1e-5);
    assert_near(rollout.moved, 1, 0);
    assert_near(rollout.moved_teacher, 1, 0);
    assert_refused(gns_rollout_run(&rollout, scene, "none.npz", "", &error), "none.npz: error: ");
}

/* Of the five claims, in their order. */
static void expect_verdicts_of(const char *rows, const char *verdicts) {
    char text[4096];
    snprintf(text, sizeof text, "%s%s",
             "measure,variant,scene,seconds,boxes,error,shape,moved,moved_engine,ms_step,ms_gradient,hours\n", rows);
    write_text("system_gns.csv", text);
    expect_verdicts(&system_gns, verdicts);
}

TEST(verdicts_follow_from_the_numbers) {
    expect_verdicts_of(
        "rollout,M = 5,stack,1,11,0.1,0,,,,,\nrollout,M = 2,stack,1,11,0.2,0,,,,,\n"
        "rollout,M = 1,stack,1,11,0.3,0,,,,,\nrollout,without noise,stack,1,11,0.4,0,,,,,\n"
        "rollout,rigid=off,stack,0.25,11,1,0,,,,,\nrollout,rigid=off,stack,1,11,1,0.06,,,,,\n"
        "large,M = 5,pyramid,5,67,1,,50,45,9,,\n\"cost\",\"width 128, M = 10\",pyramid_settled,,67,,,,,9,2,20\n",
        "yes yes yes yes yes");
    expect_verdicts_of(
        "rollout,M = 5,stack,1,11,0.1,0,,,,,\nrollout,M = 2,stack,1,11,0.4,0,,,,,\n"
        "rollout,M = 1,stack,1,11,0.3,0,,,,,\nrollout,without noise,stack,1,11,0.05,0,,,,,\n"
        "rollout,rigid=off,stack,0.25,11,1,0,,,,,\nrollout,rigid=off,stack,1,11,1,0.02,,,,,\n"
        "large,M = 5,pyramid,5,67,1,,50,20,9,,\n\"cost\",\"width 128, M = 10\",pyramid_settled,,67,,,,,9,2,100\n",
        "partly no partly no partly");
    /* What was not measured does not hold. */
    expect_verdicts_of("large,M = 5,pyramid,5,67,1,,50,4,9,,\n", "no no no no no");
}

RUN_TESTS(NULL, NULL)
