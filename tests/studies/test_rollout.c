/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scores of methods with a known ranking: the reference has no error, more sweeps have less, noise has more. */
#include "base/settings.h"
#include "made.h"

#include "studies/contenders.h"
#include "studies/rollout.h"
#include "studies/statistics.h"

OWNED_VALUE(Rollout, rollout_free)

OWNED_VALUE(SnapshotList, snapshots_free)

static const Sampling every = {.after = 1, .rest = 1}, few = {.after = 10, .rest = 50};

static void free_scores(StepScores scores[PHASES]) {
    for (int phase = 0; phase < PHASES; phase++) step_scores_free(&scores[phase]);
}

TEST(the_reference_has_no_error) {
    OWN(Scene) *scene = scene_named("stack");
    OWN(Stepper) *stepper = stepper_by(scene, "reference");
    OWN(Rollout) rollout = {0};
    StepScores scores[PHASES] = {0};
    assert_ok(rollout_run(&rollout, stepper, scene, &few, scores, &error), error);
    for (int phase = 0; phase < PHASES; phase++)
        for (int i = 0; i < scores[phase].count; i++) {
            assert_true(scores[phase].error[i] < 1e-5);
            assert_true(scores[phase].share[i] == 1);
        }
    free_scores(scores);
}

/* A box that has sunk by 5 mm catches at a seam in the engine's run. The reference, whose own contacts are mended, must
   solve these steps, not others: it is scored against itself. */
TEST(frozen_steps_have_the_contacts_of_the_engine) {
    BodyDef bodies[7];
    for (int i = 0; i < 6; i++) bodies[i] = (BodyDef){.size = {1, 1}, .fixed = true, .position = {(float)i, -0.5f}};
    bodies[6] = (BodyDef){.size = {0.8f, 0.8f}, .mass = 1, .position = {1.09f, 0.395f}, .velocity = {0.17f, 0}};
    const Scene scene = scene_of_bodies(bodies, 7, 60);
    OWN(SnapshotList) list = {0};
    StepScores scores[PHASES] = {0};
    assert_ok(snapshots_add(&list, &scene, &every, &error), error);
    const Body *last = &world_bodies(list.items[list.count - 1].world)[6];
    assert_true(last->velocity.x < 0.1f);
    OWN(Stepper) *stepper = stepper_by(&scene, "reference");
    OWN(World) *world = world_of(&scene);
    assert_ok(snapshots_score(&list, stepper, world, scores, &error), error);
    assert_true(scores[PHASE_REST].count > 50);
    for (int i = 0; i < scores[PHASE_REST].count; i++) assert_near(scores[PHASE_REST].error[i], 0, 1e-6);
    free_scores(scores);
}

/* 6 impact frames, 60 frames after; every frame is in exactly one phase. */
TEST(every_frame_is_in_one_phase) {
    OWN(Scene) *scene = scene_named("single");
    scene->frames = 200;
    OWN(Stepper) *stepper = stepper_by(scene, "engine");
    OWN(Rollout) rollout = {0};
    StepScores scores[PHASES] = {0};
    assert_ok(rollout_run(&rollout, stepper, scene, &every, scores, &error), error);
    assert_true(rollout.log.touch > 10 && rollout.log.touch < 100);
    assert_int_equal(scores[PHASE_IMPACT].count, 6);
    assert_int_equal(scores[PHASE_AFTER].count, 60);
    assert_int_equal(scores[PHASE_REST].count, 200 - 66);
    assert_int_equal(rollout.log.at[rollout.log.touch - 1].phase, PHASE_REST);
    assert_int_equal(rollout.log.at[rollout.log.touch + 65].phase, PHASE_AFTER);
    assert_int_equal(rollout.log.at[rollout.log.touch + 66].phase, PHASE_REST);
    free_scores(scores);
}

static double frozen_error(const SnapshotList *list, const Scene *scene, const char *method) {
    Error error = {0};
    StepScores scores[PHASES] = {0};
    OWN(Stepper) *stepper = stepper_by(scene, method);
    OWN(World) *world = world_of(scene);
    assert_ok(snapshots_score(list, stepper, world, scores, &error), error);
    assert_int_equal(scores[PHASE_IMPACT].count, 6);
    double mean = statistics_mean(scores[PHASE_IMPACT].error, scores[PHASE_IMPACT].count);
    free_scores(scores);
    return mean;
}

/* More sweeps give a smaller error; no warm start, or noise, a larger one. */
TEST(methods_rank_as_expected_on_frozen_steps) {
    OWN(Scene) *scene = scene_named("stack");
    OWN(SnapshotList) list = {0};
    assert_ok(snapshots_add(&list, scene, &few, &error), error);
    assert_int_equal(list.unconverged, 0);
    double by10 = frozen_error(&list, scene, "engine:k=10"), by100 = frozen_error(&list, scene, "engine:k=100");
    double by1000 = frozen_error(&list, scene, "engine:k=1000"),
           cold = frozen_error(&list, scene, "engine:k=10,warm=off");
    double constant = frozen_error(&list, scene, "pair-net:net=off"),
           reference = frozen_error(&list, scene, "reference");
    assert_true(by1000 < by100 && by100 < by10 && by10 < constant);
    assert_true(by10 != cold);
    assert_true(reference < 1e-5);
}

/* One answer is right for a falling and a resting box; a box between walls that just touch it hangs or falls. */
TEST(floors_are_of_the_sampled_steps_in_their_phases) {
    OWN(Scene) *scene = scene_named("single");
    BodyDef wedged[] = {{.size = {1, 9}, .fixed = true, .friction = 0.8f, .position = {-0.999f, 0}},
                        {.size = {1, 9}, .fixed = true, .friction = 0.8f, .position = {0.999f, 0}},
                        {.size = {1, 1}, .mass = 1, .friction = 0.8f}};
    const Scene between = scene_of_bodies(wedged, 3, 2);
    const Scene *const scenes[] = {scene, &between};
    scene->frames = 120;
    for (int i = 0; i < 2; i++) {
        FloorSum floors[PROTOCOLS][PHASES] = {0};
        OWN(SnapshotList) list = {.floors = floors[PROTOCOL_FROZEN]};
        OWN(Stepper) *stepper = stepper_by(scenes[i], "engine");
        OWN(Rollout) rollout = {.floors = floors[PROTOCOL_CLOSED]};
        assert_ok(snapshots_add(&list, scenes[i], &every, &error), error);
        assert_ok(rollout_run(&rollout, stepper, scenes[i], &every, NULL, &error), error);
        for (int p = 0; p < PROTOCOLS; p++) {
            int64_t steps = 0;
            for (int phase = 0; phase < PHASES; phase++) steps += floors[p][phase].steps;
            assert_int_equal(steps, scenes[i]->frames);
            assert_int_equal(floors[p][PHASE_IMPACT].steps, i == 0 ? 6 : 0);
            if (i == 0) assert_near(floors[p][PHASE_IMPACT].sum + floors[p][PHASE_REST].sum, 0, 1e-7);
            if (i == 1) assert_true(floors[p][PHASE_REST].sum > 0.05);
        }
    }
}

/* A box between walls that are closer to each other than it is wide: nothing keeps it out of both. */
TEST(steps_without_a_solution_are_not_scored) {
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = 20;
    scene->bomb.present = false;
    scene->body_count = 4;
    scene->bodies[1] = scene->bodies[2] = scene->bodies[0];
    scene->bodies[1].position = vec2(-50.3f, 5);
    scene->bodies[2].position = vec2(50.3f, 5);
    OWN(Stepper) *stepper = stepper_by(scene, "engine");
    OWN(Rollout) rollout = {0};
    OWN(SnapshotList) list = {0};
    StepScores scores[PHASES] = {0};
    assert_ok(rollout_run(&rollout, stepper, scene, &every, scores, &error), error);
    assert_ok(snapshots_add(&list, scene, &every, &error), error);
    assert_int_equal(scores[PHASE_REST].count + rollout.unconverged, 20);
    assert_int_equal(list.count, scores[PHASE_REST].count);
    assert_int_equal(list.unconverged, rollout.unconverged);
    assert_in_range(rollout.unconverged, 1, 20);
    free_scores(scores);
}

/* The engine's frozen steps are those of its closed loop, so the errors are the same. */
TEST(frozen_steps_of_the_engine_are_its_own) {
    OWN(Scene) *scene = scene_named("pyramid_settled");
    OWN(SnapshotList) list = {0};
    StepScores frozen[PHASES] = {0}, closed[PHASES] = {0};
    OWN(Rollout) rollout = {0};
    OWN(Stepper) *stepper = stepper_by(scene, "engine");
    assert_ok(snapshots_add(&list, scene, &few, &error), error);
    assert_ok(rollout_run(&rollout, stepper, scene, &few, closed, &error), error);
    assert_ok(snapshots_score(&list, stepper, rollout.world, frozen, &error), error);
    for (int phase = 0; phase < PHASES; phase++) {
        assert_int_equal(frozen[phase].count, closed[phase].count);
        for (int i = 0; i < frozen[phase].count; i++) assert_near(frozen[phase].error[i], closed[phase].error[i], 0);
    }
    assert_int_equal(closed[PHASE_IMPACT].count, 4);
    free_scores(frozen);
    free_scores(closed);
}

/* Keeps every body in place, with velocity 0. */
static bool stand_still(void *state, BegunStep *begun, Error *error) {
    (void)state;
    (void)error;
    for (int i = 0; i < begun->problem->body_count; i++) begun->solution->velocities[i] = (BodyVelocity){0};
    for (int i = 0; i < begun->problem->contact_count; i++) begun->solution->impulses[i] = (ContactImpulse){0};
    return true;
}

static void *create_nothing(const Settings *settings, const Scene *scene, Error *error) {
    static int nothing;
    (void)settings;
    (void)scene;
    (void)error;
    return &nothing;
}

static void destroy_nothing(void *state) { (void)state; }

/* A method that has come to rest where a box overlaps the ground. */
static Stepper *make_still_stepper(const Scene *scene, bool no_push_out) {
    static SteppingKind stepping = {.create = create_nothing, .solve = stand_still, .destroy = destroy_nothing};
    static MethodKind kind = {&stepping.description, NULL, &stepping};
    const Method method = {.text = "still", .kind = &kind};
    stepping.description = (MethodDescription){.name = "still", .no_push_out = no_push_out};
    return stepper_of(scene, &method);
}

/* The errors of the first step of a scene: frozen, and of a run of this many frames: closed loop. */
static void assert_errors(const Scene *scene, Stepper *stepper, double expected, double tolerance) {
    Error error = {0};
    OWN(Rollout) rollout = {0};
    StepScores closed[PHASES] = {0}, frozen[PHASES] = {0};
    Scene first = *scene;
    first.frames = 1;
    OWN(SnapshotList) list = {.no_push_out = true};
    assert_ok(snapshots_add(&list, &first, &every, &error), error);
    assert_ok(rollout_run(&rollout, stepper, scene, &every, closed, &error), error);
    assert_ok(snapshots_score(&list, stepper, rollout.world, frozen, &error), error);
    assert_int_equal(frozen[PHASE_REST].count, 1);
    assert_int_equal(closed[PHASE_REST].count, scene->frames);
    assert_near(frozen[PHASE_REST].error[0], expected, tolerance);
    for (int i = 0; i < scene->frames; i++) assert_near(closed[PHASE_REST].error[i], expected, tolerance);
    free_scores(closed);
    free_scores(frozen);
    stepper_destroy(stepper);
}

/* A box 60 mm in the ground: position correction pushes it out at 0.2 (60 mm - 10 mm) / dt = 0.6 m/s. That is the error
   of a method that keeps velocity 0, but not if its description has no_push_out, nor without position correction. */
TEST(push_out_counts_for_methods_that_have_it) {
    BodyDef bodies[] = {{.fixed = true, .size = {200, 20}, .position = {0, -10}, .friction = 0.2f},
                        {.size = {1, 1}, .mass = 2, .friction = 0.2f, .position = {0, 0.44f}}};
    Scene scene = scene_of_bodies(bodies, 2, 3);
    assert_errors(&scene, make_still_stepper(&scene, false), 0.6, 1e-5);
    assert_errors(&scene, make_still_stepper(&scene, true), 0, 1e-5);
    assert_errors(&scene, stepper_by(&scene, "avbd:k=50"), 0, 1e-3);
    assert_errors(&scene, stepper_by(&scene, "soft-step"), 0, 0.2); /* its one relaxing sweep leaves a spin */
    assert_errors(&scene, stepper_by(&scene, "engine:k=100"), 0, 1e-4);
    scene.position_correction = false;
    assert_errors(&scene, make_still_stepper(&scene, false), 0, 1e-5);
    assert_errors(&scene, make_still_stepper(&scene, true), 0, 1e-5);
}

/* Of every method but external ones (contender_shares()): the first steps of another launch lead to the same bits. */
TEST(runs_that_share_their_first_steps_are_whole_runs) {
    OWN(Scene) *scene = scene_named("families/gate");
    scene->frames = 100; /* the bomb appears after step 60 */
    Scene other = *scene;
    other.bomb.x.value += 0.5f;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const Contender contender = {.method = {.kind = kind}};
        if (!contender_shares(&contender) || method_lacks_network(&contender.method, scene)) continue;
        OWN(Stepper) *stepper = stepper_by(scene, kind->description->name);
        SharedSteps shared = {0};
        OWN(Rollout) whole = {0};
        OWN(Rollout) begun = {.shared = &shared};
        StepScores scores[2][PHASES] = {0};
        assert_ok(shared_steps_run(&shared, stepper, &other, 59, &few, &error), error);
        assert_ok(rollout_run(&whole, stepper, scene, &few, scores[0], &error), error);
        assert_ok(rollout_run(&begun, stepper, scene, &few, scores[1], &error), error);
        assert_int_equal(begun.log.frames, 100);
        assert_memory_equal(begun.log.position, whole.log.position, 101 * (size_t)whole.log.bodies * sizeof(Vec2));
        for (int phase = 0; phase < PHASES; phase++) {
            const int count = scores[0][phase].count;
            assert_int_equal(scores[1][phase].count, count);
            assert_memory_equal(scores[1][phase].error, scores[0][phase].error, (size_t)count * sizeof(double));
        }
        shared_steps_free(&shared);
        free_scores(scores[0]);
        free_scores(scores[1]);
    }
}

RUN_TESTS(NULL, NULL)
