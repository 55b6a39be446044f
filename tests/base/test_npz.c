/* SPDX-License-Identifier: GPL-3.0-or-later */
/* .npz: arrays come back as they went in, the same arrays give the same bytes, and damaged or hostile files are refused
   (test_npz_hostile.c: files made for harm). test_numpy.c compares with NumPy. */
#include "made.h"

#include "files.h"

#include <time.h>

static const float matrix[3][2] = {{1, -2.5F}, {0, 3e38F}, {-0.0F, 1e-45F}};
static const int64_t starts[] = {0, -1, INT64_MAX};
static const uint64_t hash = 0xfedcba9876543210U;
static const uint8_t bytes[] = {0, 1, 255, 7, 8};
static const NpzArray arrays[] = {
    {"matrix", NPZ_FLOAT32, 2, {3, 2}, matrix}, {"starts", NPZ_INT64, 1, {3}, starts},
    {"hash", NPZ_UINT64, 0, {0}, &hash},        {"bytes", NPZ_UINT8, 1, {5}, bytes},
    {"empty", NPZ_FLOAT32, 2, {0, 2}, NULL},    {"name", NPZ_TEXT, 0, {0}, "z\xc3\xa4h \xe2\x82\xac \xf0\x9f\xa7\xb1"},
    {"nothing", NPZ_TEXT, 0, {0}, ""},
};
enum { ARRAYS = sizeof arrays / sizeof arrays[0] };

static void write_arrays(const char *path) {
    Error error = {0};
    assert_ok(npz_write(path, arrays, ARRAYS, &error), error);
}

/* 1 where all arrays are read and equal, 0 where something is refused; anything else fails. */
static int read_and_compare(const char *path) {
    static const size_t sizes[] = {sizeof matrix, sizeof starts, sizeof hash, sizeof bytes, 0};
    Error error = {0};
    NpzFile *file = npz_open(path, &error);
    bool done = file != NULL;
    for (size_t i = 0; done && i < ARRAYS; i++) {
        if (arrays[i].type == NPZ_TEXT) {
            char text[32];
            done = npz_read_text(file, arrays[i].name, text, sizeof text, &error);
            if (done) assert_string_equal(text, arrays[i].data);
            continue;
        }
        FREED void *data = npz_read(file, arrays[i].name, arrays[i].type, arrays[i].rank, arrays[i].shape, &error);
        done = data != NULL;
        if (done && sizes[i] > 0) assert_memory_equal(data, arrays[i].data, sizes[i]);
    }
    npz_close(file);
    if (!done) assert_error(error, ERROR_INPUT, path);
    return done;
}

TEST(written_is_read) {
    const char *path = temporary_path("written.npz");
    write_arrays(path);
    assert_int_equal(read_and_compare(path), 1);
    OWN(NpzFile) *file = npz_of(path);
    assert_true(npz_has(file, "matrix"));
    assert_false(npz_has(file, "matri"));
    int64_t shape[2];
    assert_ok(npz_shape(file, "matrix", NPZ_FLOAT32, 2, shape, &error), error);
    assert_int_equal(shape[0], 3);
    assert_int_equal(shape[1], 2);
}

/* Whatever the time zone: a zip holds local time. */
TEST(same_arrays_same_bytes) {
    static const char *const zones[] = {"UTC0", "XXX-14", "XXX+12", "EST5EDT,M3.2.0,M11.1.0", "XXX3:30YYY,J1/0,J2/0"};
    const char *first = temporary_path("first.npz"), *second = temporary_path("second.npz");
    write_arrays(first);
    size_t size, other_size;
    FREED char *data = read_whole(first, &size);
    for (size_t i = 0; i < sizeof zones / sizeof zones[0]; i++) {
        setenv("TZ", zones[i], 1);
        tzset();
        write_arrays(second);
        FREED char *other = read_whole(second, &other_size);
        if (other_size != size || memcmp(data, other, size) != 0) fail_msg("other bytes in zone %s", zones[i]);
    }
    /* 1980-01-01 12:00 in the first local header. */
    assert_memory_equal(data + 10, "\x00\x60\x21\x00", 4);
}

TEST(mismatches_name_found_and_wanted) {
    const char *path = temporary_path("mismatch.npz");
    write_arrays(path);
    OWN(NpzFile) *file = npz_of(path);
    Error missing = {0}, type = {0}, rank = {0}, shape = {0}, text = {0};
    int64_t found[NPZ_MAX_RANK];
    assert_null(npz_read(file, "no", NPZ_FLOAT32, 0, NULL, &missing));
    assert_error(missing, ERROR_INPUT, "mismatch.npz: error: has no array 'no'");
    assert_null(npz_read(file, "matrix", NPZ_FLOAT64, 2, (int64_t[]){3, 2}, &type));
    assert_error(type, ERROR_INPUT, "array 'matrix' is float32 of 2 dimensions; expected float64 of 2");
    assert_false(npz_shape(file, "matrix", NPZ_FLOAT32, 3, found, &rank));
    assert_error(rank, ERROR_INPUT, "expected float32 of 3");
    assert_null(npz_read(file, "matrix", NPZ_FLOAT32, 2, (int64_t[]){3, 4}, &shape));
    assert_error(shape, ERROR_INPUT, "array 'matrix' has shape (3, 2); expected (3, 4)");
    char small[13], exact[14];
    assert_false(npz_read_text(file, "name", small, sizeof small, &text));
    assert_error(text, ERROR_INPUT, "'name'");
    assert_ok(npz_read_text(file, "name", exact, sizeof exact, &error), error);
}

TEST(bad_texts_are_not_written) {
    static const char *const texts[] = {
        "\xff", "\x80", "\xc3", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        NpzArray array = {"name", NPZ_TEXT, 0, {0}, texts[i]};
        assert_refused(npz_write(temporary_path("text.npz"), &array, 1, &error),
                       "text.npz: error: cannot store 'name'");
        assert_int_not_equal(access(temporary_path("text.npz"), F_OK), 0);
    }
}

/* A file with this kind and version; whether it is a table of version 3. */
static bool is_table(const char *kind, int32_t version, Error *error) {
    const NpzArray head[] = {{"kind", NPZ_TEXT, 0, {0}, kind}, {"version", NPZ_INT32, 0, {0}, &version}};
    const char *path = temporary_path("kind.npz");
    *error = (Error){0};
    assert_ok(npz_write(path, head, 2, error), *error);
    OWN(NpzFile) *file = npz_of(path);
    assert_string_equal(npz_path(file), path);
    const bool is = npz_check_kind(file, "table", 3, error);
    return is;
}

TEST(kind_and_version_are_checked) {
    assert_true(is_table("table", 3, &error));
    assert_refused(is_table("chair", 3, &error), "kind.npz: error: not a file of kind 'table'");
    assert_refused(is_table("tables", 3, &error), "kind.npz: error: not a file of kind 'table'");
    assert_refused(is_table("table", 2, &error), "table of version 2; expected version 3");
    assert_refused(is_table("table", 4, &error), "kind.npz: error: table of version 4; expected version 3");
}

RUN_TESTS(NULL, NULL)
