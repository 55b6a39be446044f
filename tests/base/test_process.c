/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "base/process.h"

TEST(a_program_is_fed_and_what_it_says_comes_back) {
    Process process;
    char text[64];
    assert_ok(process_start(&process, (const char *const[]){"tr", "a-z", "A-Z", NULL}, &error), error);
    assert_true(process_write(&process, "two boxes", 9));
    assert_ok(process_finish(&process, text, sizeof text, &error), error);
    assert_string_equal(text, "TWO BOXES");
}

TEST(failure_comes_with_its_words) {
    Process process;
    char text[64];
    assert_ok(
        process_start(&process, (const char *const[]){"sh", "-c", "echo no room >&2; echo; exit 4", NULL}, &error),
        error);
    assert_false(process_finish(&process, text, sizeof text, &error));
    assert_string_equal(error.message, "sh: error: failed (status 4)\nno room");
    error = (Error){0};
    assert_false(process_start(&process, (const char *const[]){"no-such-program", NULL}, &error));
    assert_error(error, ERROR_SYSTEM, "no-such-program: error: cannot be run");
}

/* A program that does not read must not take this one with it (SIGPIPE). */
TEST(a_deaf_program_is_survived) {
    Process process;
    char text[16], *much = calloc(1, 1 << 20);
    assert_non_null(much);
    assert_ok(process_start(&process, (const char *const[]){"true", NULL}, &error), error);
    bool taken = true;
    for (int i = 0; taken && i < 100; i++) taken = process_write(&process, much, 1 << 20);
    assert_false(taken);
    assert_ok(process_finish(&process, text, sizeof text, &error), error);
    assert_ok(process_start(&process, (const char *const[]){"sleep", "1000", NULL}, &error), error);
    process_kill(&process);
    free(much);
}

TEST(output_is_kept_in_tmpdir) {
    Process process;
    assert_int_equal(setenv("TMPDIR", "/nonexistent", 1), 0);
    assert_false(process_start(&process, (const char *const[]){"true", NULL}, &error));
    unsetenv("TMPDIR");
    assert_error(error, ERROR_SYSTEM, "/nonexistent/draft: error: cannot write: its folder does not exist");
}

RUN_TESTS(NULL, NULL)
