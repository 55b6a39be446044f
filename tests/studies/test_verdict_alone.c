/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts without a converged run, as `simulate` gives them: by the run's own energy. */
#include "made.h"
#include "studies/trial.h"

#include "studies/stability.h"

/* A box of 1 kg at 10 m/s^2, alone: 1 J lifts it by 0.1 m, and 1% of that is allowed. */
static void begin_alone(Trial *trial) {
    trial_begin(trial);
    trial->run.converged = NULL;
}

/* m: the box rises by this for one step; 10 J per metre. */
static VerdictReading lifted_by(float rise) {
    Trial trial;
    begin_alone(&trial);
    trial_go(&trial, 100);
    trial.bodies[1].position.y += rise;
    trial_go(&trial, 101);
    return trial_end(&trial);
}

TEST(energy_may_not_exceed_what_was_brought) {
    assert_verdict(lifted_by(0.0013f), VERDICT_SETTLES);
    assert_reading(lifted_by(0.0015f), VERDICT_EXPLODES, -1, 101, 0.015, 1e-5, "J");
}

/* A skin of 7.5 mm lifts the box by 15 mm; what exceeds that by more than 1.4 mm (alone: what gravity does in a step)
   or 0.1 m (beside) explodes. */
static VerdictReading lifted_with_skin(float rise, float skin, bool alone) {
    Trial trial;
    trial_begin(&trial);
    if (alone) trial.run.converged = NULL;
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
    trial.run.skin = skin;
    trial_go(&trial, 30);
    trial.bodies[1].position.y += rise;
    trial_go(&trial, 200);
    return trial_end(&trial);
}

TEST(a_skin_is_no_explosion) {
    assert_verdict(lifted_with_skin(0.0163f, 0.0075f, true), VERDICT_SETTLES);
    assert_verdict(lifted_with_skin(0.0165f, 0.0075f, true), VERDICT_EXPLODES);
    assert_verdict(lifted_with_skin(0.0163f, 0, true), VERDICT_EXPLODES);
    assert_verdict(lifted_with_skin(0.114f, 0.0075f, false), VERDICT_SETTLES);
    assert_verdict(lifted_with_skin(0.116f, 0.0075f, false), VERDICT_EXPLODES);
    assert_verdict(lifted_with_skin(0.114f, 0, false), VERDICT_EXPLODES);
}

/* Ten boxes that rest 15 mm apart, as Planck leaves them: box n is 15 n mm higher. */
TEST(a_skin_lifts_each_box_of_a_pile) {
    enum { PILE = 10 };
    for (int side = 0; side < 2; side++) {
        Body bodies[PILE + 1] = {trial_ground};
        VerdictRun run = {.gravity = {0, -10}, .dt = 1.0f / 60, .frames = 100, .stands = true, .finds_contacts = true};
        run.skin = side == 0 ? 0.0075f : 0;
        VerdictWatch watch = {0};
        for (int frame = 0; frame <= 100; frame++) {
            for (int i = 1; i <= PILE; i++) {
                bodies[i] = trial_box;
                bodies[i].position.y = (float)i - 0.5f + (frame > 0 ? 0.0149f * (float)i : 0);
            }
            const VerdictStep step = {.frame = frame, .body_count = PILE + 1, .bomb = -1, .bodies = bodies};
            assert_ok(frame == 0 ? verdict_watch_begin(&watch, &run, bodies, PILE + 1, &error)
                                 : verdict_watch_step(&watch, &step, &error),
                      error);
        }
        assert_int_equal(watch.finder.set.contact_count, side == 0 ? 2 * PILE : 0);
        assert_verdict(verdict_watch_end(&watch), side == 0 ? VERDICT_SETTLES : VERDICT_EXPLODES);
        verdict_watch_free(&watch);
    }
}

/* From 3 m to 0.5 m, 25 J are lost: 5% of them, 0.125 m, may come back. The box has lost its 25 J for a whole
   second. */
static VerdictReading regains(float rise) {
    Trial trial;
    begin_alone(&trial);
    trial.run.stands = false;
    trial.bodies[1].position.y = 3;
    trial_go(&trial, 10);
    trial.bodies[1].position.y = 0.5f;
    trial_go(&trial, 180);
    trial.bodies[1].position.y += rise;
    trial_go(&trial, 181);
    return trial_end(&trial);
}

TEST(a_little_lost_energy_may_come_back) {
    assert_verdict(regains(0.12f), VERDICT_SETTLES);
    assert_reading(regains(0.13f), VERDICT_EXPLODES, -1, 181, 1.3, 1e-5, "J");
}

TEST(an_added_body_brings_its_energy) {
    Trial trial;
    begin_alone(&trial);
    trial_go(&trial, 100);
    trial.bodies[trial.count++] = trial_box;
    trial.bodies[2].position = vec2(3, 50);
    trial.bodies[2].velocity = vec2(0, -30);
    trial_go(&trial, 101);
    assert_false(verdict_watch_is_final(&trial.watch));
    trial.bodies[2].velocity = vec2(0, -35); /* 162 J more; 9.95 J are 1% of its 495 J and 450 J */
    trial_go(&trial, 102);
    assert_reading(trial_end(&trial), VERDICT_EXPLODES, 2, 102, 162.5, 1e-3, "J");
}

/* Boxes that overlap by 0.2 m at the start are pushed apart: 2 J. After the first second nothing may be gained. */
static VerdictReading pushed_apart_at(int frame) {
    Trial trial;
    begin_alone(&trial);
    trial.contacts[0].separation = -0.2f;
    trial_go(&trial, 1);
    trial.contacts[0].separation = -0.01f;
    trial_go(&trial, frame - 1);
    trial.bodies[1].position.y += 0.2f;
    trial_go(&trial, 120);
    return trial_end(&trial);
}

TEST(an_overlap_at_the_start_may_add_energy) {
    assert_verdict(pushed_apart_at(30), VERDICT_SETTLES);
    assert_verdict(pushed_apart_at(90), VERDICT_EXPLODES);
}

/* Until the bomb touches the box, the box is meant to stand. */
static VerdictReading falls_at(int frame, bool *fallen) {
    Trial trial;
    begin_alone(&trial);
    trial.run.stands = false;
    trial.run.until_bomb = true;
    for (int step = 1; step <= 50; step++) {
        if (step == frame) trial.bodies[1].angle = 1;
        if (step == 10) {
            trial.bodies[2] = trial_box;
            trial.bodies[2].position = vec2(0, 5);
            trial.count = 3;
        }
        if (step == 11) trial.bomb = 2;
        if (step == 20) trial.contacts[trial.contact_count++] = (ContactPoint){.a = 1, .b = 2};
        trial_go(&trial, step);
    }
    *fallen = trial.watch.bodies[1].fell > 0;
    return trial_end(&trial);
}

TEST(falling_is_judged_until_the_bomb_touches) {
    bool fallen;
    assert_reading(falls_at(15, &fallen), VERDICT_FALLS, 1, 15, 57.2958, 1e-3, "deg");
    assert_verdict(falls_at(25, &fallen), VERDICT_SETTLES);
    assert_true(fallen);
    assert_verdict(falls_at(51, &fallen), VERDICT_SETTLES);
    assert_false(fallen);
}

/* The rule and the table of studies agree on which scenes are meant to stand. Of those with a rigid answer, two come to
   stand after a start with a speed. */
TEST(scenes_without_bomb_and_speed_stand) {
    for (int i = 0; i < stability_study_count; i++) {
        const StabilityStudy *study = &stability_studies[i];
        OWN(Scene) *scene = stability_study_scene(study, SOURCE_DIR "/scenes", study->scan.to, &error);
        assert_ok(scene != NULL, error);
        if (verdict_run_of(scene).stands != study->stands && study->rigid == NULL)
            fail_msg("%s is %smeant to stand", study->name, study->stands ? "" : "not ");
    }
}

static void judge_both(const Scene *scene, const char *text, bool stands, const EnergyLog *converged, int found[2]) {
    Error error = {0};
    VerdictReading alone, converging;
    const Method method = method_named(text);
    const VerdictRun runs[2] = {beside(scene, stands, converged), beside(scene, stands, NULL)};
    assert_ok(verdict_run(&converging, scene, &method, &runs[0], &error), error);
    assert_ok(verdict_run(&alone, scene, &method, &runs[1], &error), error);
    found[0] += converging.verdict >= VERDICT_EXPLODES;
    found[1] += alone.verdict != converging.verdict;
}

/* In three studies, a third of the runs explode, and the verdicts with and without a converged run are the same. */
TEST(verdicts_agree_with_those_beside_the_converged_run) {
    static const char *const names[] = {"iterations_cold", "heavy_on_one", "bomb_speed"};
    static const char *const methods[] = {"engine", "momentum:k=10",
                                          "pair-net:network=" SOURCE_DIR "/scenes/networks/pair-net.npz"};
    int found[2] = {0, 0}, count = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const StabilityStudy *study = stability_study_find(names[i]);
        double values[BORDER_POINTS_MAX];
        const int value_count = border_scan_values(&study->scan, values);
        for (int v = 0; v < value_count; v++) {
            OWN(EnergyLog) converged = {0};
            OWN(Scene) *scene = stability_study_scene(study, SOURCE_DIR "/scenes", values[v], &error);
            assert_ok(scene != NULL, error);
            if (scene->frames > 600) scene->frames = 600;
            assert_ok(converged_run_once(&converged, scene, &error), error);
            for (size_t m = 0; m < sizeof methods / sizeof *methods; m++, count++)
                judge_both(scene, methods[m], study->stands, &converged, found);
        }
    }
    printf("%d runs, %d explode or are NaN or infinite, %d have another verdict alone\n", count, found[0], found[1]);
    assert_true(found[0] >= count / 4);
    assert_int_equal(found[1], 0);
}

RUN_TESTS(NULL, NULL)
