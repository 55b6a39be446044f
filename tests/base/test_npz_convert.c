/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays of other types and orders, as NumPy writes them: converted exactly, or refused with the value that does not
   fit. */
#include "made.h"

#include "python.h"

/* Opens a file with `array=expression`. */
static NpzFile *make(const char *expression) {
    const char *path = temporary_path("array.npz");
    run_python(printed("import sys, numpy as np\nnp.savez(sys.argv[1], array=%s)\n", expression), path);
    return npz_of(path);
}

static void expect(const char *expression, NpzType type, int rank, const int64_t *shape, const void *wanted,
                   size_t size) {
    Error error = {0};
    NpzFile *file = make(expression);
    npz_convert(file);
    void *data = npz_read(file, "array", type, rank, shape, &error);
    assert_ok(data != NULL, error);
    if (memcmp(data, wanted, size) != 0) fail_msg("%s is read as something else", expression);
    free(data);
    npz_close(file);
}

/* One file has [0, 1, 100] in all types. */
static NpzFile *make_all(void) {
    const char *path = temporary_path("types.npz");
    run_python("import sys, numpy as np\n"
               "types = 'f2 f4 f8 i1 i2 i4 i8 u1 u2 u4 u8'.split()\n"
               "arrays = {side + t: np.array([0, 1, 100], ('<' if side == 'l' else '>') + t) for t in types for side "
               "in 'lb'}\n"
               "np.savez(sys.argv[1], bool=[False, True, True], **arrays)\n",
               path);
    return npz_of(path);
}

static void expect_in(NpzFile *file, const char *name, NpzType type, const void *wanted, size_t size) {
    Error error = {0};
    const int64_t three[] = {3};
    FREED void *data = npz_read(file, name, type, 1, three, &error);
    assert_ok(data != NULL, error);
    if (memcmp(data, wanted, size) != 0) fail_msg("%s is read as something else", name);
}

TEST(numbers_of_any_type_become_the_type_that_is_read) {
    const float f4[] = {0, 1, 100};
    const double f8[] = {0, 1, 100};
    const int32_t i4[] = {0, 1, 100};
    const int64_t i8[] = {0, 1, 100};
    const uint8_t u1[] = {0, 1, 100};
    const uint32_t u4[] = {0, 1, 100};
    const uint64_t u8[] = {0, 1, 100};
    OWN(NpzFile) *file = make_all();
    npz_convert(file);
    size_t count = 0;
    for (const char *name; (name = npz_name(file, count)) != NULL; count++) {
        if (strcmp(name, "bool") == 0) continue;
        expect_in(file, name, NPZ_FLOAT32, f4, sizeof f4);
        expect_in(file, name, NPZ_FLOAT64, f8, sizeof f8);
        expect_in(file, name, NPZ_INT32, i4, sizeof i4);
        expect_in(file, name, NPZ_INT64, i8, sizeof i8);
        expect_in(file, name, NPZ_UINT8, u1, sizeof u1);
        expect_in(file, name, NPZ_UINT32, u4, sizeof u4);
        expect_in(file, name, NPZ_UINT64, u8, sizeof u8);
    }
    assert_int_equal(count, 23);
    expect_in(file, "bool", NPZ_UINT8, (const uint8_t[]){0, 1, 1}, 3);
}

/* Each number keeps what its new type can hold. */
TEST(numbers_are_rounded_once) {
    const int64_t two[] = {2};
    expect("np.array([0.1, -1/60])", NPZ_FLOAT32, 1, two, (const float[]){0.1F, (float)(-1.0 / 60)}, 8);
    expect("np.array([np.nan, -np.inf])", NPZ_FLOAT64, 1, two, (const double[]){(double)NAN, (double)-INFINITY}, 16);
    expect("np.array([-2**63, 2**63 - 1])", NPZ_INT64, 1, two, (const int64_t[]){INT64_MIN, INT64_MAX}, 16);
    expect("np.array([0, 2**64 - 1], 'u8')", NPZ_UINT64, 1, two, (const uint64_t[]){0, UINT64_MAX}, 16);
    expect("np.array([-128, 127], 'i1')", NPZ_INT32, 1, two, (const int32_t[]){-128, 127}, 8);
    expect("np.array([-1e30, 5e-324])", NPZ_FLOAT32, 1, two, (const float[]){-1e30F, 0}, 8);
    expect("np.array([1/3, -65504, 2**-24, -0., 6e-5], 'f2')", NPZ_FLOAT32, 1, (const int64_t[]){5},
           (const float[]){0.333251953125F, -65504, 0x1p-24F, -0.0F, 1007 * 0x1p-24F}, 20);
    expect("np.array([np.inf, -np.inf], 'f2')", NPZ_FLOAT64, 1, two,
           (const double[]){(double)INFINITY, (double)-INFINITY}, 16);
    /* To even: the float below and the float above are equally near. */
    expect("np.array([16777217, 16777219])", NPZ_FLOAT32, 1, two, (const float[]){16777216, 16777220}, 8);
}

TEST(fortran_order_is_turned) {
    const int64_t three_by_two[] = {3, 2}, cube[] = {2, 3, 2};
    const float rows[] = {0, 1, 2, 3, 4, 5}, cells[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    expect("np.asfortranarray(np.arange(6.).reshape(3, 2))", NPZ_FLOAT32, 2, three_by_two, rows, sizeof rows);
    expect("np.asfortranarray(np.arange(12, dtype='f4').reshape(2, 3, 2))", NPZ_FLOAT32, 3, cube, cells, sizeof cells);
    expect("np.asfortranarray(np.arange(12, dtype='>i8').reshape(2, 3, 2))", NPZ_FLOAT32, 3, cube, cells, sizeof cells);
    expect("np.asfortranarray(np.zeros((0, 2)))", NPZ_FLOAT32, 2, (const int64_t[]){0, 2}, "", 0);
}

TEST(one_number_is_a_scalar) {
    expect("[1/60]", NPZ_FLOAT32, 0, NULL, (const float[]){1.0F / 60}, 4);
    expect("np.float64(2.5)", NPZ_FLOAT32, 0, NULL, (const float[]){2.5F}, 4);
}

static void expect_refused(const char *expression, bool converts, NpzType type, int rank, const int64_t *shape,
                           const char *reason) {
    Error error = {0};
    NpzFile *file = make(expression);
    if (converts) npz_convert(file);
    void *data = npz_read(file, "array", type, rank, shape, &error);
    if (data != NULL) fail_msg("taken: %s", expression);
    assert_error(error, ERROR_INPUT, reason);
    npz_close(file);
}

TEST(what_does_not_fit_is_refused) {
    const int64_t one[] = {1}, grid[] = {2, 2};
    expect_refused("[[0, 0], [1e39, 0]]", true, NPZ_FLOAT32, 2, grid,
                   "array 'array': item [1, 0] is 9.9999999999999994e+38, which does not fit into float32");
    expect_refused("np.asfortranarray([[0, -1e39], [0, 0]])", true, NPZ_FLOAT32, 2, grid, "item [0, 1] is -9.99");
    expect_refused("[2**31]", true, NPZ_INT32, 1, one, "item [0] is 2147483648, which does not fit into int32");
    expect_refused("[-1]", true, NPZ_UINT8, 1, one, "item [0] is -1, which does not fit into uint8");
    expect_refused("[-1]", true, NPZ_UINT64, 1, one, "item [0] is -1, which does not fit into uint64");
    expect_refused("[256]", true, NPZ_UINT8, 1, one, "item [0] is 256, which does not fit into uint8");
    expect_refused("[2**63]", true, NPZ_INT64, 1, one, "does not fit into int64");
    expect_refused("[1e19]", true, NPZ_INT64, 1, one, "does not fit into int64");
    expect_refused("0.5", true, NPZ_INT32, 0, NULL, "its value is 0.5, which does not fit into int32");
    expect_refused("[np.nan]", true, NPZ_UINT8, 1, one, "item [0] is nan, which does not fit into uint8");
    expect_refused("[1., 2.]", true, NPZ_FLOAT32, 0, NULL, "is float64 of 1 dimensions; expected float32 of 0");
    expect_refused("'1'", true, NPZ_FLOAT32, 0, NULL, "is text of 0 dimensions; expected float32 of 0");
}

RUN_TESTS(NULL, NULL)
