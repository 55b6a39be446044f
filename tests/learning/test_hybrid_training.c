/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small complete learnings on the single box, and the method with what they learned. */
#include "trainings.h"
#include "owned.h"

#include "learning/hybrid_training.h"

enum { LAUNCHES = 120 };

typedef struct Counts {
    int launches, asked, answered, late, late_answered, grown, added, full, checked;
    double worst; /* mean error of a launch's answers */
    float grown_error;
    int shrunk, known;   /* ellipsoids, by the trace of their matrix M; entries so far */
    double traces[1000]; /* [known] */
} Counts;

/* A new entry's M is at least 1 / tolerance^2 in every direction; a growth lowers its trace, a cut raises it. */
static void count_shrunk(Counts *counts, const HybridLaunch *launch) {
    const HybridMemory *memory = launch->memory;
    const bool checks = launch->number % 10 == 1;
    for (int i = 0; memory != NULL && i < memory->entry_count; i++) {
        const float *metric = memory->metrics + (size_t)i * (size_t)memory->metric_size;
        double trace = 0;
        for (int row = 0, at = 0; row < memory->key_size; at += ++row + 1) {
            trace += (double)metric[at];
            if (i >= counts->known && launch->grown == 0)
                assert_true(metric[at] >= 0.999f / (memory->tolerance * memory->tolerance));
        }
        if (i < counts->known && trace > 1.0001 * counts->traces[i]) {
            assert_true(checks);
            counts->shrunk++;
        }
        counts->traces[i] = trace;
    }
    counts->known = memory != NULL ? memory->entry_count : 0;
}

static void count(void *context, const HybridLaunch *launch) {
    Counts *counts = context;
    assert_int_equal(launch->number, ++counts->launches);
    counts->asked += launch->asked;
    counts->answered += launch->answered;
    if (launch->number > LAUNCHES / 2) {
        counts->late += launch->asked;
        counts->late_answered += launch->answered;
    }
    counts->grown += launch->grown;
    counts->added += launch->added;
    counts->full += launch->full;
    counts->checked += launch->checked;
    if (launch->checked > 0) counts->worst = fmax(counts->worst, launch->error / launch->checked);
    counts->grown_error = fmaxf(counts->grown_error, launch->grown_error);
    count_shrunk(counts, launch);
}

static HybridTraining training_of(Counts *counts) {
    *counts = (Counts){0};
    return (HybridTraining){.launches = LAUNCHES,
                            .steps = 6,
                            .components = HYBRID_STANDARD_COMPONENTS,
                            .tolerance = 0.1f,
                            .limit = 1 << 20,
                            .seed = 1,
                            .on_launch = count,
                            .context = counts};
}

static HybridMemory *learn(const Scene *scene, const HybridTraining *training, const Progress *progress) {
    Error error = {0};
    HybridMemory *memory = hybrid_training_run(scene, training, progress, &error);
    assert_ok(memory != NULL, error);
    return memory;
}

TEST(familiar_impacts_are_answered_within_the_tolerance) {
    OWN(Scene) *scene = scene_named("single");
    Counts counts;
    const HybridTraining training = training_of(&counts);
    OWN(HybridMemory) *memory = learn(scene, &training, NULL);
    assert_int_equal(counts.launches, LAUNCHES);
    assert_int_equal(memory->launches, LAUNCHES);
    assert_int_equal(counts.added, memory->entry_count);
    assert_int_equal(counts.full, 0);
    assert_true(counts.grown > 20);
    assert_true(4 * counts.late_answered > counts.late);
    assert_true(counts.checked > 0 && counts.worst < 0.1);
}

TEST(ellipsoids_grow_by_right_answers_and_shrink_by_wrong_ones) {
    OWN(Scene) *scene = scene_named("single");
    Counts counts;
    HybridTraining training = training_of(&counts);
    training.tolerance = 0.3f; /* a check finds an answer that is wrong by more */
    OWN(HybridMemory) *memory = learn(scene, &training, NULL);
    assert_non_null(memory);
    assert_true(counts.worst > 0.3 && counts.shrunk > 0);
    assert_true(counts.grown_error > 0.15f && counts.grown_error <= training.tolerance);
}

/* Each ends where the memory has no room for one more entry. */
TEST(the_limit_holds_and_is_reported) {
    OWN(Scene) *scene = scene_named("single");
    Counts counts;
    HybridTraining training = training_of(&counts);
    training.limit = 40000;
    OWN(HybridMemory) *memory = learn(scene, &training, NULL);
    assert_true(counts.full > 0);
    assert_true(hybrid_memory_bytes(memory) <= training.limit);
    assert_true(hybrid_memory_bytes(memory) + hybrid_memory_entry_bytes(memory, 4) + 4096 > training.limit);
}

TEST(a_stopped_learning_keeps_its_memory) {
    OWN(Scene) *scene = scene_named("single");
    Counts counts;
    const HybridTraining training = training_of(&counts);
    int left = 77;
    OWN(HybridMemory) *part = learn(scene, &training, &(Progress){stop_at, &left});
    assert_int_equal(part->launches, 77);
    assert_int_equal(counts.added, part->entry_count);
    left = 1;
    counts.launches = 0;
    assert_null(hybrid_training_run(scene, &training, &(Progress){stop_at, &left}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped before anything was learned");
}

static Trajectory *run(const Scene *scene, const char *name, const char *path) {
    Error error = {0};
    Method method;
    assert_ok(path != NULL ? method_with_network(&method, name, path, &error) : method_parse(&method, name, &error),
              error);
    return run_with(scene, &method);
}

static void assert_same_end(Trajectory *a, Trajectory *b) {
    assert_int_equal(trajectory_frame_hash(a, a->frames - 1), trajectory_frame_hash(b, b->frames - 1));
    trajectory_destroy(a);
    trajectory_destroy(b);
}

/* net=off and an empty memory solve every step to convergence; a memory gives the same run each time, and another
   one. */
TEST(the_method_without_its_memory_is_its_twin) {
    OWN(Scene) *scene = scene_named("single");
    Counts counts;
    const HybridTraining training = training_of(&counts);
    OWN(HybridMemory) *memory = learn(scene, &training, NULL);
    const char *path = temporary_path("memory.npz");
    assert_ok(hybrid_memory_write(memory, path, &error), error);
    scene->frames = 120;
    Scene bare = *scene;
    bare.network_count = 0;
    assert_same_end(run(scene, "hybrid:net=off", path), run(&bare, "hybrid", NULL));
    assert_same_end(run(scene, "hybrid", path), run(scene, "hybrid", path));
    int answered = 0;
    for (float x = -4; x <= 4; x++) {
        Launch launch = launch_of(scene);
        launch.x = x;
        Scene launched = launch_scene(scene, &launch);
        OWN(Trajectory) *with = run(&launched, "hybrid", path), *without = run(&launched, "hybrid:net=off", path);
        answered += trajectory_frame_hash(with, 120) != trajectory_frame_hash(without, 120);
    }
    assert_true(answered > 0);
}

RUN_TESTS(NULL, NULL)
