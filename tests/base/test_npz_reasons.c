/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the machine lacks is not blamed on the file. */
#include "library_allocations.h"
#include "owned.h"

#include "base/npz.h"
#include "cli/output_checks.h"

#include <sys/resource.h>

static const char *path;
static struct rlimit before;

static float numbers[300];

static bool write_all(Error *error) {
    const NpzArray arrays[] = {{"small", NPZ_FLOAT32, 0, {0}, &numbers[7]}, {"large", NPZ_FLOAT32, 1, {300}, numbers}};
    return npz_write(path, arrays, 2, error);
}

FIXTURE(begin) {
    static char name[256];
    path = strcpy(name, temporary_path("a.npz"));
    for (int i = 0; i < 300; i++) numbers[i] = (float)(i * i % 97);
    assert_ok(write_all(&error), error);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
}

/* Lets only so many more files be opened. */
static void allow_files(unsigned more) {
    const int next = dup(0);
    assert_true(next >= 0);
    close(next);
    struct rlimit limit = {(rlim_t)next + more, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
}

FIXTURE(allow_all) { assert_int_equal(setrlimit(RLIMIT_NOFILE, &before), 0); }

/* libzip needs a descriptor of its own. */
TEST_WITH(a_lack_of_descriptors_is_no_damage, NULL, allow_all) {
    for (unsigned more = 0; more < 2; more++) {
        error = (Error){0};
        allow_files(more);
        assert_null(npz_open(path, &error));
        allow_all(NULL);
        assert_error(error, ERROR_SYSTEM, "Too many open files");
    }
}

/* Nor does it make a file one of another kind, which an output does not replace. */
TEST_WITH(a_lack_of_descriptors_is_no_other_kind, NULL, allow_all) {
    allow_files(1);
    assert_false(output_check_npz(path, NULL, &error));
    allow_all(NULL);
    assert_error(error, ERROR_SYSTEM, "Too many open files");
}

static bool read_all(Error *error) {
    const int64_t shape[] = {300};
    bool done = false;
    OWN(NpzFile) *file = npz_open(path, error);
    FREED float *small = file != NULL ? npz_read(file, "small", NPZ_FLOAT32, 0, NULL, error) : NULL;
    FREED float *large = small != NULL ? npz_read(file, "large", NPZ_FLOAT32, 1, shape, error) : NULL;
    if (large != NULL) {
        assert_memory_equal(small, &numbers[7], sizeof *small);
        assert_memory_equal(large, numbers, sizeof numbers);
        done = true;
    }
    return done;
}

/* libzip reports it as damage, as no archive, or as no error. */
TEST(a_lack_of_memory_is_no_damage) { assert_memory_is_named(read_all); }

/* The file is that of the last write that was done. */
TEST(writing_names_the_lack_of_memory) {
    assert_memory_is_named(write_all);
    assert_ok(read_all(&error), error);
}

RUN_TESTS(begin, NULL)
