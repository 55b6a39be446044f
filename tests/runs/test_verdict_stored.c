/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a stored run is that of the run while it was made. */
#include "made.h"

#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"

/* Both verdicts, in words. */
static void judge(Scene *scene, const char *text, char made[TRAJECTORY_VERDICT_SIZE], Trajectory **run) {
    const Method method = method_named(text);
    Error error = {0};
    SimulateVerdict verdict;
    assert_ok(simulate_verdict_begin(&verdict, scene, &method, &error), error);
    const StepObserver observer = {verdict_watch_observe, &verdict.watch};
    Recorder *recorder = recorder_create(scene, &method, &error);
    const RunWatch watch = {.recorder = recorder, .observers = &observer, .observer_count = 1};
    assert_ok(simulate_watched(scene, &method, &watch, &error), error);
    assert_true(simulate_verdict_end(&verdict, &error));
    simulate_verdict_words(&verdict, made);
    simulate_verdict_free(&verdict);
    *run = recorder_take(recorder);
    recorder_destroy(recorder);
}

static VerdictReading stored(const Scene *scene, const Trajectory *run, char words[TRAJECTORY_VERDICT_SIZE]) {
    SimulateVerdict verdict;
    Error error = {0};
    assert_ok(simulate_verdict_of_run(&verdict, run, scene, 0, &error), error);
    simulate_verdict_words(&verdict, words);
    const VerdictReading reading = verdict.reading;
    simulate_verdict_free(&verdict);
    return reading;
}

static const struct {
    const char *scene, *method;
    int frames;
} cases[] = {
    {"stack", "engine", 300}, {"stack", "pair-net", 90}, {"pyramid", "momentum", 200}, {"single", "engine", 120}};

TEST(a_stored_run_has_the_verdict_of_simulate) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char made[TRAJECTORY_VERDICT_SIZE], read[TRAJECTORY_VERDICT_SIZE];
        OWN(Scene) *scene = scene_named(cases[i].scene);
        OWN(Trajectory) * run;
        scene->frames = cases[i].frames;
        judge(scene, cases[i].method, made, &run);
        run->no_contacts = true; /* found again in any case */
        stored(scene, run, read);
        assert_string_equal(read, made);
    }
}

TEST(a_run_without_velocities_has_those_of_its_poses) {
    char made[TRAJECTORY_VERDICT_SIZE], read[TRAJECTORY_VERDICT_SIZE];
    OWN(Scene) *scene = scene_named("stack");
    OWN(Trajectory) * run;
    scene->bomb.present = false;
    scene->frames = 200;
    judge(scene, "interior", made, &run);
    run->no_velocities = true;
    for (int i = 0; i < run->frames * run->bodies; i++) {
        run->velocity[i] = vec2(NAN, NAN);
        run->angular_velocity[i] = NAN;
    }
    assert_int_equal(stored(scene, run, read).verdict, VERDICT_SETTLES);
    assert_int_equal(stored(NULL, run, read).verdict, VERDICT_SETTLES);
}

/* J: of boxes of 1 kg and 1 m. */
static double energy(const Trajectory *run, int frame) {
    double sum = 0;
    for (int i = frame * run->bodies + 1; i < (frame + 1) * run->bodies; i++) {
        const Vec2 v = run->velocity[i];
        sum += 10 * (double)run->position[i].y + ((double)v.x * v.x + (double)v.y * v.y) / 2 +
               pow((double)run->angular_velocity[i], 2) / 12;
    }
    return sum;
}

TEST(figures_of_a_stored_run) {
    char made[TRAJECTORY_VERDICT_SIZE], read[TRAJECTORY_VERDICT_SIZE];
    OWN(Scene) *scene = scene_named("stack");
    OWN(Trajectory) * run;
    scene->bomb.present = false;
    scene->frames = 120;
    judge(scene, "engine", made, &run);
    /* Box 10 is lifted by 5 m in frame 100, and box 1 pushed 0.3 m into the ground for one frame. */
    for (int frame = 100; frame < run->frames; frame++) run->position[frame * run->bodies + 10].y += 5;
    run->position[110 * run->bodies + 1].y -= 0.3f;
    const VerdictReading reading = stored(scene, run, read);
    assert_int_equal(reading.verdict, VERDICT_EXPLODES);
    assert_true(reading.deepest > 0.3 && reading.deepest < 0.33);
    double most = 0;
    for (int frame = 1; frame < run->frames; frame++) most = fmax(most, energy(run, frame) - energy(run, 0));
    assert_near(reading.excess, most, 1e-3);
    assert_true(most > 10 && most < 50);
}

/* Box 10 lies on the ground from frame 30 on; box 9 is out of the scene from frame 60 on. */
TEST(the_first_that_fell_is_told) {
    char made[TRAJECTORY_VERDICT_SIZE], read[TRAJECTORY_VERDICT_SIZE];
    OWN(Scene) *scene = scene_named("stack");
    OWN(Trajectory) * run;
    scene->bomb.present = false;
    scene->frames = 80;
    judge(scene, "engine", made, &run);
    for (int frame = 30; frame < run->frames; frame++) {
        run->position[frame * run->bodies + 10] = vec2(30, 0.5f);
        if (frame >= 60) run->position[frame * run->bodies + 9] = vec2(500, -50);
    }
    const VerdictReading reading = stored(scene, run, read);
    assert_true(reading.verdict == VERDICT_FALLS && reading.frame == 30 && reading.body == 10);
    assert_non_null(strstr(read, "falls; 2 of 10 fell, first at 0.5 s"));
    assert_non_null(strstr(read, "; 1 out of the scene"));
}

TEST(another_scene_is_refused) {
    OWN(Scene) *scene = scene_named("stack"), *other = scene_named("pyramid");
    char made[TRAJECTORY_VERDICT_SIZE];
    OWN(Trajectory) * run;
    SimulateVerdict verdict;
    scene->frames = 2;
    judge(scene, "engine", made, &run);
    assert_refused(simulate_verdict_of_run(&verdict, run, other, 0, &error), "but the run has 12");
    simulate_verdict_free(&verdict);
    run->size[3].x = 2;
    assert_refused(simulate_verdict_of_run(&verdict, run, scene, 0, &error),
                   "is not the scene of the run: body 3 is 2 x 1 m, not 1 x 1 m");
    simulate_verdict_free(&verdict);
}

RUN_TESTS(NULL, NULL)
