/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy reads a trajectory, and a trajectory that NumPy wrote is read. */
#include "made.h"

#include "example.h"
#include "python.h"

TEST(numpy_reads_every_member) {
    const char *path = temporary_path("run.npz");
    Trajectory *t = example_trajectory();
    assert_ok(trajectory_write(t, path, &error), error);
    trajectory_destroy(t);
    run_python("import sys, numpy as np\n"
               "f = np.load(sys.argv[1], allow_pickle=False)\n"
               "nan, f4 = np.nan, '<f4'\n"
               "frame = np.arange(4, dtype=f4)\n"
               "p = np.zeros((4, 3, 2), f4); v = np.zeros((4, 3, 2), f4)\n"
               "a = np.zeros((4, 3), f4); w = np.zeros((4, 3), f4)\n"
               "p[:, 0] = (0, -10)\n"
               "p[:, 1, 0] = np.float32(0.1) * frame; p[:, 1, 1] = 0.25\n"
               "a[:, 1] = -0.0; v[:, 1, 0] = frame; v[:, 1, 1] = -0.5; w[:, 1] = 3e-30\n"
               "p[:, 2, 0] = -5 + frame; p[:, 2, 1] = 15; a[:, 2] = 1.5; v[:, 2] = (7.5, -22.5); w[:, 2] = -1\n"
               "for x in p, a, v, w: x[:2, 2] = nan\n"
               "want = {\n"
               "  'version': np.array(1, '<i4'), 'scene': np.array('ex\\u00e4mple'), 'method': np.array('engine'),\n"
               "  'scene_hash': np.array(0xfedcba9876543210, '<u8'), 'dt': np.array(np.float32(1) / np.float32(60), "
               "f4),\n"
               "  'bomb': np.array(2, '<i4'), 'camera': np.array([[0, 5], [16, 9]], f4),\n"
               "  'size': np.array([[100, 20], [1, 0.5], [1, 0.5]], f4), 'fixed': np.array([1, 0, 0], 'u1'),\n"
               "  'mass': np.array([0, 0.5, 50], f4),\n"
               "  'position': p, 'angle': a, 'velocity': v, 'angular_velocity': w,\n"
               "  'contact_start': np.array([0, 0, 0, 2, 2], '<i8'), 'contact_bodies': np.array([[0, 1], [0, 1]], "
               "'<i4'),\n"
               "  'contact_feature': np.array([0x01020300, 0x01020301], '<u4'),\n"
               "  'contact_point': np.array([[0, 0.01], [1, 0.01]], f4), 'contact_normal': np.array([[0, 1], [0, "
               "1]], f4),\n"
               "  'contact_impulse': np.array([[0.5, -0.25], [1.5, -0.25]], f4),\n"
               "  'verdict': np.array('falls at 0.05 s (body 1, ex\\u00e4mple)'),\n"
               "  'verdict_frame': np.array(3, '<i4'), 'verdict_body': np.array(1, '<i4')}\n"
               "assert f.files == list(want), f.files\n"
               "for name, array in want.items():\n"
               "    got = f[name]\n"
               "    assert got.dtype == array.dtype, (name, got.dtype)\n"
               "    assert got.shape == array.shape, (name, got.shape)\n"
               "    np.testing.assert_array_equal(got, array, name)\n"
               "assert np.signbit(f['angle'][:, 1]).all()\n",
               path);
}

#define MAKE                                                                                                 \
    "import sys, numpy as np\n"                                                                              \
    "n = np.zeros\n"                                                                                         \
    "arrays = dict(version=np.int32(1), scene='falling', method='by hand', scene_hash=np.uint64(5),\n"       \
    "  dt=np.float32(0.5), bomb=np.int32(-1), camera=n((2, 2), 'f4'), size=np.ones((1, 2), 'f4'),\n"         \
    "  fixed=n(1, 'u1'), position=n((3, 1, 2), 'f4'), angle=n((3, 1), 'f4'), velocity=n((3, 1, 2), 'f4'),\n" \
    "  angular_velocity=n((3, 1), 'f4'), contact_start=n(4, 'i8'), contact_bodies=n((0, 2), 'i4'),\n"        \
    "  contact_feature=n(0, 'u4'), contact_point=n((0, 2), 'f4'), contact_normal=n((0, 2), 'f4'),\n"         \
    "  contact_impulse=n((0, 2), 'f4'))\n"                                                                   \
    "arrays['position'][:, 0, 1] = [7, 6, 4]\n"
#define SAVE "np.savez_compressed(sys.argv[1], **arrays)\n"

TEST(what_numpy_writes_is_read) {
    const char *path = temporary_path("numpy.npz");
    run_python(MAKE SAVE, path);
    Trajectory *t = trajectory_of(path);
    assert_string_equal(t->scene, "falling");
    assert_string_equal(t->method, "by hand");
    assert_true(t->frames == 3 && t->bodies == 1 && t->bomb == -1 && t->dt == 0.5F && t->scene_hash == 5);
    assert_true(t->position[0].y == 7 && t->position[1].y == 6 && t->position[2].y == 4);
    trajectory_destroy(t);
}

/* The same, with one thing changed. */
static void expect_refused(const char *change, const char *reason) {
    const char *path = temporary_path("run.npz");
    char program[2048];
    snprintf(program, sizeof program, "%s%s\n%s", MAKE, change, SAVE);
    run_python(program, path);
    Error error = {0};
    Trajectory *t = trajectory_read(path, &error);
    if (t != NULL) fail_msg("taken: %s", change);
    assert_error(error, ERROR_INPUT, "run.npz: error: ");
    assert_error(error, ERROR_INPUT, reason);
}

TEST(what_does_not_fit_is_refused) {
    expect_refused("arrays['version'] = np.int32(2)", "run.npz: error: trajectory of version 2; expected version 1");
    expect_refused("del arrays['angle']", "has no array 'angle'");
    expect_refused("arrays['angle'] = n((3, 2), 'f4')", "array 'angle' has shape (3, 2); expected (3, 1)");
    expect_refused("arrays['size'] = n((1, 2))", "body 0: its size must be finite");
    expect_refused("arrays['position'] = n((3, 1, 3), 'f4')",
                   "array 'position' has shape (3, 1, 3); expected (3, 1, 2)");
    expect_refused("arrays['position'] = n((0, 1, 2), 'f4')", "0 frames of 1 bodies");
    expect_refused("arrays['contact_feature'] = n(1, 'u4')", "array 'contact_feature' has shape (1)");
    expect_refused("arrays['contact_start'][3] = 1", "contact_start must rise from 0, 0 to the number of contacts");
    expect_refused("arrays['scene'] = 'x' * 128", "text 'scene' is");
    expect_refused("arrays['scene'] = '\\u00e4' * 64", "text 'scene' is");
}

RUN_TESTS(NULL, NULL)
