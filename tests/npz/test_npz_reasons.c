/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the machine lacks is not blamed on the file. */
#include "testing.h"

#include "npz/npz.h"
#include "npz/output_check.h"

#include <sys/resource.h>

static const char *path;
static struct rlimit before;

static int begin(void **state) {
    (void)state;
    static char name[256];
    Error error = {0};
    static const float number = 1;
    path = strcpy(name, temporary_path("a.npz"));
    assert_ok(npz_write(path, &(NpzArray){"a", NPZ_FLOAT32, 0, {0}, &number}, 1, &error), error);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
    return 0;
}

/* Lets only so many more files be opened. */
static void allow_files(unsigned more) {
    const int next = dup(0);
    assert_true(next >= 0);
    close(next);
    struct rlimit limit = {(rlim_t)next + more, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
}

static int allow_all(void **state) {
    (void)state;
    return setrlimit(RLIMIT_NOFILE, &before);
}

/* libzip needs a descriptor of its own. */
static void a_lack_of_descriptors_is_no_damage(void **state) {
    (void)state;
    for (unsigned more = 0; more < 2; more++) {
        Error error = {0};
        allow_files(more);
        assert_null(npz_open(path, &error));
        allow_all(NULL);
        assert_error(error, ERROR_SYSTEM, "Too many open files");
    }
}

/* Nor does it make a file one of another kind, which an output does not replace. */
static void a_lack_of_descriptors_is_no_other_kind(void **state) {
    (void)state;
    Error error = {0};
    allow_files(1);
    assert_false(output_check_npz(path, NULL, &error));
    allow_all(NULL);
    assert_error(error, ERROR_SYSTEM, "Too many open files");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(a_lack_of_descriptors_is_no_damage, allow_all),
                                       cmocka_unit_test_teardown(a_lack_of_descriptors_is_no_other_kind, allow_all)};
    return cmocka_run_group_tests(tests, begin, NULL);
}
