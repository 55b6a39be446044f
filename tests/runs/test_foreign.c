/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs of other programs: position, angle, size and dt are enough; what is absent has a meaning; wrong names are
   named. */
#include "made.h"

#include "example.h"
#include "python.h"

/* A ground, a box that falls, and one that comes in frame 1, in NumPy's default types. */
#define MAKE                                                                                    \
    "import sys, numpy as np\n"                                                                 \
    "a = dict(position=np.zeros((3, 3, 2)), angle=np.zeros((3, 3)), size=np.full((3, 2), 2),\n" \
    "         dt=1 / 60)\n"                                                                     \
    "a['position'][:, 1, 1] = 3, 2, 1\n"                                                        \
    "a['position'][0, 2] = a['angle'][0, 2] = np.nan\n"
#define SAVE "np.savez(sys.argv[1], **a)\n"

static const char *make(const char *name, const char *change) {
    const char *path = temporary_path(name);
    char program[2048];
    snprintf(program, sizeof program, MAKE "%s\n" SAVE, change);
    run_python(program, path);
    return path;
}

static Trajectory *read_changed(const char *name, const char *change) { return trajectory_of(make(name, change)); }

TEST(four_arrays_are_enough) {
    OWN(Trajectory) *t = read_changed("v\303\266lker.2.npz", "");
    assert_string_equal(t->scene, "v\303\266lker.2");
    assert_string_equal(t->method, "v\303\266lker.2");
    assert_true(t->scene_hash == 0 && t->bomb == -1 && t->camera_size.x == 0 && t->camera_size.y == 0);
    assert_true(t->frames == 3 && t->bodies == 3 && t->dt == (float)(1.0 / 60));
    assert_true(t->size[2].x == 2 && t->position[4].y == 2);
    assert_true(t->no_velocities && isnan(t->velocity[4].x) && isnan(t->angular_velocity[4]));
    assert_true(t->no_contacts && t->contact_start[3] == 0);
    /* The third never moves either, but it comes late. */
    assert_memory_equal(t->fixed, ((const uint8_t[]){1, 0, 0}), 3);
}

TEST(what_never_moves_is_static_unless_it_is_stated) {
    Trajectory *t = read_changed("run.npz", "a['fixed'] = np.array([False, True, False])");
    assert_memory_equal(t->fixed, ((const uint8_t[]){0, 1, 0}), 3);
    trajectory_destroy(t);
    t = read_changed("run.npz", "a['angle'][:, 0] = 0, 0.1, 0");
    assert_int_equal(t->fixed[0], 0);
    trajectory_destroy(t);
    t = read_changed("run.npz", "a['position'] = a['position'][1:2]; a['angle'] = a['angle'][1:2]");
    assert_memory_equal(t->fixed, ((const uint8_t[]){0, 0, 0}), 3);
    trajectory_destroy(t);
}

TEST(types_and_orders_are_converted) {
    OWN(Trajectory) *t = read_changed("run.npz", "a['position'] = np.asfortranarray(a['position'].astype('>f8'))\n"
                                                 "a.update(bomb=[1], fixed=[1., 0., 0.], camera=[[0, 1], [8, 9]],\n"
                                                 "         scene_hash=7, version=np.int64(1))");
    assert_true(t->position[1].y == 3 && t->position[4].y == 2 && t->position[7].y == 1 && t->position[7].x == 0);
    assert_true(t->bomb == 1 && t->scene_hash == 7 && t->camera_center.y == 1 && t->camera_size.x == 8);
}

TEST(long_and_strange_names_of_files_become_names) {
    char name[200];
    memset(name, 'x', sizeof name);
    strcpy(name + 150, ".npz");
    Trajectory *t = read_changed(name, "");
    assert_true(strlen(t->scene) >= 120 && strlen(t->scene) < TRAJECTORY_NAME_SIZE);
    trajectory_destroy(t);
    t = read_changed("a\377b.npz", "");
    assert_string_equal(t->scene, "a_b");
    trajectory_destroy(t);
}

/* Unknown velocities are neither equal to known ones nor different from them. */
TEST(only_poses_are_compared_with_a_run_without_velocities) {
    OWN(Trajectory) *t = read_changed("run.npz", ""),
                    *moving = read_changed("run.npz", "a['velocity'] = a['position'] * 0 + 1\n"
                                                      "a['angular_velocity'] = a['angle'] * 0");
    assert_false(moving->no_velocities);
    TrajectoryDifference difference;
    trajectory_compare(t, moving, &difference);
    assert_true(difference.equal && difference.poses_only);
    moving->exact[trajectory_exact_at(moving, 4, 2)] = 0.5;
    trajectory_compare(moving, t, &difference);
    assert_true(!difference.equal && difference.frame == 1 && difference.body == 1);
    assert_true(difference.angle == 0.5 && difference.speed == 0);
}

static void expect_refused(const char *change, const char *reason) {
    Error error = {0};
    Trajectory *t = trajectory_read(make("run.npz", change), &error);
    if (t != NULL) fail_msg("taken: %s", change);
    assert_error(error, ERROR_INPUT, "run.npz: error: ");
    assert_error(error, ERROR_INPUT, reason);
}

#define RENAME(from, to) "a['" to "'] = a.pop('" from "')"

TEST(wrong_names_are_suggested) {
    expect_refused(RENAME("position", "positions"),
                   "unknown array 'positions': did you mean 'position'? Rename or remove it");
    expect_refused(RENAME("angle", "theta"), "has no array 'angle'; a trajectory needs position, angle, size and dt");
    expect_refused(RENAME("size", "sizes"), "did you mean 'size'?");
    expect_refused(RENAME("size", "Size"), "did you mean 'size'?");
    expect_refused("a['velocities'] = a['position']", "did you mean 'velocity'?");
}

TEST(names_of_bodies_are_read_and_written) {
    OWN(Trajectory) *t =
        read_changed("run.npz", "n = a['body_name'] = np.zeros((3, 32), 'u1'); n[1, :3] = list(b'ram')");
    const char *path = temporary_path("names.npz");
    assert_ok(trajectory_write(t, path, &error), error);
    OWN(Trajectory) *again = trajectory_read(path, &error);
    assert_ok(again != NULL, error);
    for (int i = 0; i < 3; i++) assert_string_equal(again->name[i].text, i == 1 ? "ram" : "");
    const uint64_t hash = trajectory_hash(t);
    assert_true(trajectory_hash(again) == hash);
    again->name[1].text[0] = 'd'; /* a picture can show it */
    assert_true(trajectory_hash(again) != hash);
}

TEST(what_is_needed_is_told) {
    expect_refused("del a['position']", "has no array 'position'; a trajectory needs position, angle, size and dt");
    expect_refused("del a['angle']", "error: has no array 'angle'");
    expect_refused("del a['size']", "error: has no array 'size'");
    expect_refused("del a['dt']", "error: has no array 'dt'");
    expect_refused("a = dict(x=1)", "not a trajectory: has no array 'position'");
    expect_refused("a['kind'] = 'dataset'", "not a trajectory but a file of kind 'dataset'");
    expect_refused("a['velocity'] = a['position']",
                   "has 'velocity' but not 'angular_velocity'; give both, or none of the two");
    expect_refused("a['contact_start'] = np.zeros(4)", "has 'contact_start' but not 'contact_bodies'");
    expect_refused("a['contact_point'] = np.zeros((0, 2))", "give both, or none of the six contact arrays");
    expect_refused("a['verdict'] = 'falls'",
                   "has 'verdict' but not 'verdict_frame'; give both, or none of the three of the verdict");
    expect_refused("a.update(verdict='x' * 256, verdict_frame=0, verdict_body=0)", "text 'verdict' is");
    expect_refused("a.update(verdict='falls', verdict_frame=3, verdict_body=0)", "the verdict is on frame 3 of 3");
    expect_refused("a['version'] = 2", "trajectory of version 2; expected version 1");
}

#define NAMES "n = a['body_name'] = np.zeros((3, 32), 'u1'); "

RUN_TESTS(NULL, NULL)
