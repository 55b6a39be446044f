/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy reads what npz_write writes, and npz_read what numpy.savez and savez_compressed write. Needs
   /usr/bin/python3 with NumPy (python3-numpy). */
#include "made.h"

#include "python.h"

static const float matrix[3][2] = {{1, -2.5F}, {0, 3e38F}, {-0.0F, 1e-45F}};
static const double reals[2] = {0.1, -1e300};
static const int32_t cube[2][1][2] = {{{1, -2}}, {{INT32_MIN, 4}}};
static const uint32_t features[1] = {UINT32_MAX};
static const int64_t starts[3] = {0, -1, INT64_MAX};
static const uint64_t hash = 0xfedcba9876543210U;
static const uint8_t bytes[1][1][5][1] = {{{{0}, {1}, {255}, {7}, {8}}}};
static const char text[] = "z\xc3\xa4h \xe2\x82\xac \xf0\x9f\xa7\xb1";

TEST(numpy_reads_what_is_written) {
    const NpzArray arrays[] = {
        {"matrix", NPZ_FLOAT32, 2, {3, 2}, matrix},
        {"reals", NPZ_FLOAT64, 1, {2}, reals},
        {"cube", NPZ_INT32, 3, {2, 1, 2}, cube},
        {"features", NPZ_UINT32, 1, {1}, features},
        {"starts", NPZ_INT64, 1, {3}, starts},
        {"hash", NPZ_UINT64, 0, {0}, &hash},
        {"bytes", NPZ_UINT8, 4, {1, 1, 5, 1}, bytes},
        {"empty", NPZ_FLOAT32, 2, {0, 2}, NULL},
        {"text", NPZ_TEXT, 0, {0}, text},
        {"nothing", NPZ_TEXT, 0, {0}, ""},
    };
    const char *path = temporary_path("written.npz");
    assert_ok(npz_write(path, arrays, sizeof arrays / sizeof arrays[0], &error), error);
    run_python("import sys, zipfile, numpy as np\n"
               "f = np.load(sys.argv[1], allow_pickle=False)\n"
               "want = {\n"
               "  'matrix': np.array([[1, -2.5], [0, 3e38], [-0.0, 1e-45]], '<f4'),\n"
               "  'reals': np.array([0.1, -1e300], '<f8'),\n"
               "  'cube': np.array([[[1, -2]], [[-2**31, 4]]], '<i4'),\n"
               "  'features': np.array([2**32 - 1], '<u4'),\n"
               "  'starts': np.array([0, -1, 2**63 - 1], '<i8'),\n"
               "  'hash': np.array(0xfedcba9876543210, '<u8'),\n"
               "  'bytes': np.array([0, 1, 255, 7, 8], 'u1').reshape(1, 1, 5, 1),\n"
               "  'empty': np.zeros((0, 2), '<f4'),\n"
               "  'text': np.array('z\\u00e4h \\u20ac \\U0001f9f1'),\n"
               "  'nothing': np.array('')}\n"
               "assert f.files == list(want), f.files\n"
               "for name, array in want.items():\n"
               "    got = f[name]\n"
               "    assert got.dtype == array.dtype, (name, got.dtype)\n"
               "    assert got.shape == array.shape, (name, got.shape)\n"
               "    assert got.tobytes() == array.tobytes(), (name, got)\n"
               "z = zipfile.ZipFile(sys.argv[1])\n"
               "assert z.testzip() is None\n"
               "for i in z.infolist():\n"
               "    assert i.date_time == (1980, 1, 1, 12, 0, 0) and i.compress_type == zipfile.ZIP_DEFLATED, i\n"
               "    with z.open(i) as member:\n"
               "        assert np.lib.format.read_magic(member) == (1, 0)\n"
               "        np.lib.format.read_array_header_1_0(member)\n"
               "        assert member.tell() % 64 == 0, member.tell()\n",
               path);
}

static void expect_array(NpzFile *file, const NpzArray *wanted, size_t size) {
    Error error = {0};
    FREED void *data = npz_read(file, wanted->name, wanted->type, wanted->rank, wanted->shape, &error);
    assert_ok(data != NULL, error);
    assert_memory_equal(data, wanted->data, size);
}

static void expect_arrays(const char *path) {
    Error error = {0};
    OWN(NpzFile) *file = npz_of(path);
    expect_array(file, &(NpzArray){"matrix", NPZ_FLOAT32, 2, {3, 2}, matrix}, sizeof matrix);
    expect_array(file, &(NpzArray){"reals", NPZ_FLOAT64, 1, {2}, reals}, sizeof reals);
    expect_array(file, &(NpzArray){"cube", NPZ_INT32, 3, {2, 1, 2}, cube}, sizeof cube);
    expect_array(file, &(NpzArray){"features", NPZ_UINT32, 1, {1}, features}, sizeof features);
    expect_array(file, &(NpzArray){"starts", NPZ_INT64, 1, {3}, starts}, sizeof starts);
    expect_array(file, &(NpzArray){"hash", NPZ_UINT64, 0, {0}, &hash}, sizeof hash);
    expect_array(file, &(NpzArray){"bytes", NPZ_UINT8, 4, {1, 1, 5, 1}, bytes}, sizeof bytes);
    expect_array(file, &(NpzArray){"empty", NPZ_FLOAT32, 2, {0, 2}, ""}, 0);
    char got[32];
    assert_ok(npz_read_text(file, "text", got, sizeof got, &error), error);
    assert_string_equal(got, text);
    assert_ok(npz_read_text(file, "nothing", got, sizeof got, &error), error);
    assert_string_equal(got, "");
}

#define MAKE                                                                                             \
    "import io, sys, zipfile, numpy as np\n"                                                             \
    "arrays = dict(matrix=np.array([[1, -2.5], [0, 3e38], [-0.0, 1e-45]], '<f4'), reals=np.array([0.1, " \
    "-1e300]),\n"                                                                                        \
    "  cube=np.array([[[1, -2]], [[-2**31, 4]]], '<i4'), features=np.array([2**32 - 1], '<u4'),\n"       \
    "  starts=np.array([0, -1, 2**63 - 1]), hash=np.uint64(0xfedcba9876543210),\n"                       \
    "  bytes=np.array([0, 1, 255, 7, 8], 'u1').reshape(1, 1, 5, 1), empty=np.zeros((0, 2), '<f4'),\n"    \
    "  text='z\\u00e4h \\u20ac \\U0001f9f1', nothing='')\n"

TEST(what_numpy_writes_is_read) {
    const char *path = temporary_path("numpy.npz");
    run_python(MAKE "np.savez(sys.argv[1], **arrays)\n", path);
    expect_arrays(path);
    run_python(MAKE "np.savez_compressed(sys.argv[1], **arrays)\n", path);
    expect_arrays(path);
    run_python(MAKE "with zipfile.ZipFile(sys.argv[1], 'w') as z:\n"
                    "    for name, array in arrays.items():\n"
                    "        b = io.BytesIO()\n"
                    "        np.lib.format.write_array(b, np.asarray(array), version=(2, 0))\n"
                    "        z.writestr(name + '.npy', b.getvalue())\n",
               path);
    expect_arrays(path);
}

RUN_TESTS(NULL, NULL)
