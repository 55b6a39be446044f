/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cmocka with the headers it wants, and what every test needs, mathematics too. Include this first. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka.h comes after the four above. */
#include <cmocka.h>

#include "base/base.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* TEST(law) { ... } is a test, in the order of the file; `state` is cmocka's, and `error` is an empty one of the test's
   own. TEST_WITH() has the fixtures that are called before and after it, each of which is FIXTURE(name) { ... } with
   the same two. RUN_TESTS(before, after) ends the file: its fixtures, or NULL, are called once, before and after
   all. */
enum { TESTS_MAX = 64 }; /* of a file */
static struct CMUnitTest tests_of_file[TESTS_MAX] __attribute__((unused));
static size_t test_count __attribute__((unused));

#define TEST(law) TEST_WITH(law, NULL, NULL)
#define TEST_WITH(law, before, after)                                                                 \
    static void law(void **state, Error error);                                                       \
    static void call_##law(void **state) { law(state, (Error){0}); }                                  \
    __attribute__((constructor)) static void add_##law(void) {                                        \
        if (test_count == TESTS_MAX) abort();                                                         \
        tests_of_file[test_count++] = (struct CMUnitTest){#law, call_##law, (before), (after), NULL}; \
    }                                                                                                 \
    static void law(__attribute__((unused)) void **state, __attribute__((unused)) Error error)

#define FIXTURE(name)                                                         \
    static void do_##name(void **state, Error error);                         \
    static int name(void **state) { return do_##name(state, (Error){0}), 0; } \
    static void do_##name(__attribute__((unused)) void **state, __attribute__((unused)) Error error)

#define RUN_TESTS(before, after) \
    int main(void) { return _cmocka_run_group_tests("tests", tests_of_file, test_count, before, after); }

/* Fails with the error's own words where `condition` is false. */
#define assert_ok(condition, error)                        \
    do {                                                   \
        if (!(condition)) fail_msg("%s", (error).message); \
    } while (0)

/* Fails unless the error is of this kind and its message contains the text. */
#define assert_error(error, expected_kind, text)                                                               \
    do {                                                                                                       \
        if (strstr((error).message, (text)) == NULL) fail_msg("\"%s\" lacks \"%s\"", (error).message, (text)); \
        assert_int_equal((error).kind, (expected_kind));                                                       \
    } while (0)

/* Fails unless the call, which sets the caller's `error`, is refused (false or NULL) as bad input, with a message that
   contains all these texts. */
#define assert_refused(call, ...)                                               \
    do {                                                                        \
        const char *const texts_[] = {__VA_ARGS__};                             \
        error = (Error){0};                                                     \
        if (call) fail_msg("%s is not refused: %s", #call, texts_[0]);          \
        for (size_t text_ = 0; text_ < sizeof texts_ / sizeof *texts_; text_++) \
            assert_error(error, ERROR_INPUT, texts_[text_]);                    \
    } while (0)

/* cmocka's assert_float_equal compares floats; this one says what it found. */
#define assert_near(actual, expected, tolerance)                                                         \
    do {                                                                                                 \
        double actual_ = (double)(actual), expected_ = (double)(expected);                               \
        if (!(actual_ - expected_ <= (double)(tolerance) && expected_ - actual_ <= (double)(tolerance))) \
            fail_msg("%s is %.9g, not %.9g", #actual, actual_, expected_);                               \
    } while (0)

static char temporary_folder[64];

static inline int remove_entry(const char *path, const struct stat *status, int flag, struct FTW *walk) {
    (void)status, (void)flag, (void)walk;
    return remove(path);
}

static inline void remove_temporary_folder(void) { nftw(temporary_folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS); }

/* A path below a fresh folder of this process, which goes at exit; in a static ring of eight buffers. */
static inline const char *temporary_path(const char *name) {
    static char paths[8][256];
    static int next;
    if (temporary_folder[0] == '\0') {
        strcpy(temporary_folder, "/tmp/twinbox-test-XXXXXX");
        if (mkdtemp(temporary_folder) == NULL) abort();
        atexit(remove_temporary_folder);
    }
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", temporary_folder, name);
    return path;
}

/* As printf() would print it; in a static ring of sixteen buffers. */
__attribute__((format(printf, 1, 2))) static inline const char *printed(const char *format, ...) {
    static _Thread_local char texts[16][1024];
    static _Thread_local int next;
    char *text = texts[next++ % 16];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof texts[0], format, arguments);
    va_end(arguments);
    return text;
}

/* Puts these bytes in a file and returns its path. A new file each time: some file systems write an overwritten one to
   disk at once, for safety. */
static inline const char *write_bytes(const char *path, const void *data, size_t size) {
    remove(path);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}
