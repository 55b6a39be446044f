/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of the module, linked to this program: runs are those of simulate(), and damaged bundles are refused.
   Networks come from files here, and the archives of bundles are called by other names. */
#include "base/random.h"
#include "made.h"
#include "sanitized.h"

#include "live/bundle.h"
#include "live/live.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#define npz_archive_open bundle_archive_open
#define npz_archive_close bundle_archive_close
#define npz_archive_count bundle_archive_count
#define npz_archive_name bundle_archive_name
#define npz_archive_check bundle_archive_check
#define npz_archive_begin bundle_archive_begin
#define npz_archive_read bundle_archive_read
#include "live/module/npz_bundle.c"

static void *bundle_of(const char *scene, size_t *size) {
    char path[512];
    void *bundle;
    Error error = {0};
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s.yaml", scene);
    assert_ok(live_pack(path, NULL, 0, &bundle, size, &error), error);
    return bundle;
}

static LiveScene *open_scene(const char *name) {
    size_t size;
    void *bundle = bundle_of(name, &size);
    LiveScene *scene = live_open(bundle, (int)size);
    if (scene == NULL) fail_msg("%s", live_error());
    return scene;
}

static LiveRun *begin(LiveScene *scene, const char *settings, const char *method) {
    LiveRun *run = live_begin(scene, settings, method, 1);
    if (run == NULL) fail_msg("%s", live_error());
    return run;
}

static void check_contacts(const LiveRun *live, const Trajectory *run) {
    const TrajectoryContact *contacts = live_contacts(live);
    for (int frame = 0; frame <= run->frames; frame++)
        assert_int_equal(live_contact_start(live, frame), run->contact_start[frame]);
    assert_memory_equal(contacts, run->contacts, (size_t)run->contact_start[run->frames] * sizeof *contacts);
    for (int step = 1; step < run->frames; step++)
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++)
            assert_int_equal(live_contact_mode(live, (int)i), trajectory_mode(run, step, i));
}

static void check_run(const char *name, const char *settings, const char *method) {
    LiveScene *live_scene = open_scene(name);
    LiveRun *live = begin(live_scene, settings, method);
    Scene *scene = scene_named(name);
    if (settings[0] != '\0') scene->bomb.x.value = (float)atof(strchr(settings, '=') + 1);
    Trajectory *run = run_by(scene, method);
    const size_t states = (size_t)run->frames * (size_t)run->bodies;
    assert_int_equal(live_frames(live), run->frames);
    assert_int_equal(live_bodies(live), run->bodies);
    assert_int_equal(live_bomb(live), run->bomb);
    for (int frame = 0; frame < run->frames - 1;) frame = live_step(live, 1 + frame % 7);
    assert_int_equal(live_step(live, 1), run->frames - 1);
    for (int frame = 0; frame < run->frames; frame++)
        assert_true(live_hash(live, frame) == trajectory_frame_hash(run, frame));
    assert_memory_equal(live_positions(live), run->position, states * sizeof *run->position);
    assert_memory_equal(live_angles(live), run->angle, states * sizeof *run->angle);
    assert_memory_equal(live_velocities(live), run->velocity, states * sizeof *run->velocity);
    assert_memory_equal(live_spins(live), run->angular_velocity, states * sizeof *run->angular_velocity);
    assert_memory_equal(live_sizes(live), run->size, (size_t)run->bodies * sizeof *run->size);
    check_contacts(live, run);
    trajectory_destroy(run);
    scene_destroy(scene);
    live_end(live);
    live_close(live_scene);
}

TEST(runs_are_those_of_simulate) {
    static const char *const methods[] = {"engine",
                                          "momentum:k=5",
                                          "soft-step",
                                          "soft-step:keep=0.05",
                                          "avbd",
                                          "interior",
                                          "pair-net:network=" SOURCE_DIR "/scenes/networks/pair-net.npz"};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        check_run("stack", "bomb_x=-1.25", methods[i]);
        check_run("families/gate", "", methods[i]);
    }
}

TEST(a_run_can_be_left_and_gone_on_with) {
    LiveScene *scene = open_scene("stack");
    LiveRun *one = begin(scene, "bomb_x=1", "engine"), *other = begin(scene, "bomb_x=2,iterations=4", "momentum");
    live_step(one, 50);
    live_step(other, 80);
    live_step(one, 30);
    const uint64_t interrupted = live_hash(one, 80);
    live_end(one);
    one = begin(scene, "bomb_x=1", "engine");
    live_step(one, 80);
    assert_true(live_hash(one, 80) == interrupted);
    assert_true(live_hash(one, 81) == 0);
    live_end(one);
    live_end(other);
    live_close(scene);
}

/* A bomb that appears after some frames inside a box: the run ends before, with the words of the program. */
TEST(a_refused_launch_ends_the_run) {
    static const char text[] = "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 60\n"
                               "bodies: [{static: true, size: [9, 1], position: [0, 0]}]\n"
                               "bomb: {x: 0, y: 0, size: [1, 1], mass: 1, frame: 30}\n";
    const char *path = temporary_path("inside.yaml");
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    void *bundle;
    size_t size;
    assert_ok(live_pack(path, NULL, 0, &bundle, &size, &error), error);
    LiveScene *scene = live_open(bundle, (int)size);
    LiveRun *run = begin(scene, "", "engine");
    assert_int_equal(live_step(run, 60), 29);
    assert_non_null(strstr(live_failure(run), "inside: error: the launch at x = 0 m"));
    assert_null(live_verdict(run));
    assert_true(isnan(live_positions(run)[30 * 2 * live_bodies(run)]));
    live_end(run);
    live_close(scene);
}

TEST(a_bundle_has_no_folder) {
    size_t size;
    FREED char *bundle = bundle_of("stack", &size);
    for (size_t i = 0; i + 7 < size; i++) assert_memory_not_equal(bundle + i, "scenes/", 7);
}

/* The list says it; programs cannot, and the plain module has no network. */
TEST(methods_are_live_as_the_list_says) {
#define LIVE true, false
#define LIVE_NETWORK true, true
#define NOT_LIVE false, false
#define PLACE(name, where) {where},
    static const struct { bool live, network; } places[] = {METHODS(PLACE, PLACE)};
    for (int i = 0; method_kinds[i].description != NULL; i++) {
        const MethodDescription *method = method_kinds[i].description;
        if (live_has_method(method) != places[i].live) fail_msg("%s is live, or not", method->name);
        if (places[i].live && (method->external || method->needs_network != places[i].network))
            fail_msg("%s is in a wrong module", method->name);
    }
}

TEST(methods_that_a_page_lacks_are_refused) {
    void *bundle;
    size_t size;
    const char *const methods[] = {"engine", "playback"};
    assert_refused(live_pack(SOURCE_DIR "/scenes/stack.yaml", methods, 2, &bundle, &size, &error),
                   "playback: error: a page cannot run this method");
}

/* Any bytes: refused, or a scene. The sanitizers see what the module would not. */
TEST(damaged_bundles_do_no_harm) {
    size_t size;
    int opened = 0;
    const int rounds = 3000 / sampled(10);
    FREED unsigned char *bundle = bundle_of("stability/stack_height", &size);
    uint64_t random = 1;
    for (int round = 0; round < rounds; round++) {
        const size_t length = round % 4 == 0 ? (size_t)random_below(&random, (int)size) : size;
        unsigned char *damaged = malloc(length + 1);
        memcpy(damaged, bundle, length);
        for (int k = random_below(&random, 4); k >= 0 && length > 0; k--)
            damaged[random_below(&random, (int)length)] ^= (unsigned char)(1 << random_below(&random, 8));
        LiveScene *scene = live_open(damaged, (int)length);
        LiveRun *run = scene != NULL ? live_begin(scene, "height=3", "engine", 0) : NULL;
        opened += scene != NULL;
        if (run != NULL && live_frames(run) < 10000) live_step(run, 2);
        live_end(run);
        live_close(scene);
    }
    assert_true(opened > rounds / 10 && opened < rounds);
}

/* A bundle's numbers are little-endian. */
#define PIECE(name, length, text) "\0\0\0" length "\0\0\0" name "\0" text

TEST(archives_of_bundles_have_their_members) {
    static const char members[] = "\x06" PIECE("a.npy", "\3", "xyz") "\x06" PIECE("b.npy", "\0", "");
    char bundle[128] = "\x02\0\0\0", data[8];
    uint64_t size;
    bundle[4] = (char)(sizeof members - 1);
    memcpy(bundle + 8, "n", 2);
    memcpy(bundle + 10, members, sizeof members - 1);
    bundle_use((Bundle){(const unsigned char *)bundle, 10 + sizeof members - 1});
    assert_refused(bundle_archive_open("other", &size, &error), "other: error: the page does not have this network");
    error = (Error){0};
    NpzArchive *archive = bundle_archive_open("n", &size, &error);
    assert_ok(archive != NULL, error);
    assert_int_equal(size, sizeof members - 1);
    assert_int_equal(bundle_archive_count(archive), 2);
    assert_string_equal(bundle_archive_name(archive, 1, &error), "b.npy");
    assert_true(bundle_archive_check(archive, 0, "a", &size, &error) && size == 3);
    assert_int_equal(bundle_archive_begin(archive, 0, "a", data, sizeof data, &error), 3);
    assert_true(bundle_archive_read(archive, 0, "a", 1, data, 2, &error));
    assert_memory_equal(data, "yz", 2);
    assert_refused(bundle_archive_read(archive, 0, "a", 1, data, 3, &error), "array 'a' is damaged");
    assert_refused(bundle_archive_read(archive, 1, "b", 1, data, 0, &error), "array 'b' is damaged");
    bundle_archive_close(archive);
    bundle[4]--; /* the last piece is cut off */
    bundle_use((Bundle){(const unsigned char *)bundle, 9 + sizeof members - 1});
    assert_refused(bundle_archive_open("n", &size, &error), "the page does not have this network, or it is damaged");
}

RUN_TESTS(NULL, NULL)
