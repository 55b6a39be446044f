/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy reads a trajectory. */

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

RUN_TESTS(NULL, NULL)
