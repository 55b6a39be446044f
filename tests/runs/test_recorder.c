/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run that is written while it is made gives the files of a run that is recorded in memory and written then. */
#include "made.h"

#include "files.h"

static Scene *read_scene(const char *name, int frames) {
    Scene *scene = scene_named(name);
    scene->frames = frames;
    return scene;
}

static void record_to(const Scene *scene, const Method *method, const RecorderOutput *outputs, bool no_contacts,
                      uint64_t *hash) {
    Error error = {0};
    Recorder *recorder = recorder_create_to(scene, method, outputs, 2, no_contacts, &error);
    assert_ok(recorder != NULL, error);
    assert_ok(simulate_watched(scene, method, &(RunWatch){.recorder = recorder}, &error), error);
    assert_ok(recorder_finish(recorder, &error), error);
    *hash = recorder_state_hash(recorder);
    recorder_destroy(recorder);
}

/* Runs of one part, of many parts, of which the last is full or not, with a bomb that comes and a body that goes. */
TEST(files_are_those_of_a_run_in_memory) {
    static const struct {
        const char *scene;
        int frames;
    } runs[] = {{"stack", 1}, {"stack", 90}, {"single", 300}, {"pyramid", 900}, {"stability/top_removed", 4000}};
    Method method = method_named("engine");
    for (size_t i = 0; i < 2 * sizeof runs / sizeof *runs; i++) {
        const bool no_contacts = i % 2 == 1;
        OWN(Scene) *scene = read_scene(runs[i / 2].scene, runs[i / 2].frames);
        OWN(Trajectory) *run = run_with(scene, &method);
        if (no_contacts) {
            trajectory_restart_contacts(run);
            trajectory_end_contacts(run);
            run->no_contacts = true;
        }
        const char *npz = temporary_path("run.npz"), *csv = temporary_path("run.csv");
        assert_ok(trajectory_write(run, temporary_path("expected.npz"), &error), error);
        assert_ok(write_as(run, TRAJECTORY_CSV, temporary_path("expected.csv"), &error), error);
        uint64_t hash;
        record_to(scene, &method, (RecorderOutput[]){{npz, TRAJECTORY_NPZ}, {csv, TRAJECTORY_CSV}}, no_contacts, &hash);
        assert_same_file(npz, temporary_path("expected.npz"));
        assert_same_file(csv, temporary_path("expected.csv"));
        assert_true(hash == trajectory_frame_hash(run, run->frames - 1));
    }
}

/* What libzip 1.7.3 and zlib 1.2.13 wrote. */
TEST(golden_files_have_the_same_bytes) {
    static const char *const names[] = {"stack-engine", "pyramid-pair-net", "pyramid_settled-engine"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *golden = printed(SOURCE_DIR "/golden/trajectories/%s.npz", names[i]);
        OWN(Trajectory) *run = trajectory_of(golden);
        const char *again = temporary_path("again.npz");
        assert_ok(trajectory_write(run, again, &error), error);
        assert_same_file(again, golden);
    }
}

static bool fail_late(void *context, int frame, const World *world, Error *error) {
    (void)context, (void)world;
    return frame < 800 || error_input(error, "observer", "enough");
}

TEST(a_run_that_fails_leaves_no_file) {
    Method method = method_named("engine");
    OWN(Scene) *scene = read_scene("pyramid", 900);
    const char *path = temporary_path("failed.npz");
    const RecorderOutput output = {path, TRAJECTORY_NPZ};
    Recorder *recorder = recorder_create_to(scene, &method, &output, 1, false, &error);
    assert_ok(recorder != NULL, error);
    const StepObserver observer = {fail_late, NULL};
    const RunWatch watch = {.recorder = recorder, .observers = &observer, .observer_count = 1};
    assert_refused(simulate_watched(scene, &method, &watch, &error), "observer: error: enough");
    recorder_destroy(recorder);
    assert_int_not_equal(access(path, F_OK), 0);
}

RUN_TESTS(NULL, NULL)
