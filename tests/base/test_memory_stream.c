/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "base/file.h"

#include <stdbool.h>

/* The linker hands realloc() of this program to this function (tests/CMakeLists.txt). */
static bool memory_is_short;
void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size) { return memory_is_short ? NULL : __real_realloc(block, size); }

enum { LINES = 3000 };

static void write_lines(FILE *file, int first, int last) {
    for (int i = first; i < last; i++) fprintf(file, "line %d\n", i);
}

TEST(holds_what_is_written) {
    char *text, line[32];
    size_t size, at = 0;
    FILE *file = memory_stream(&text, &size);
    assert_non_null(file);
    write_lines(file, 0, LINES);
    const long end = ftell(file);
    assert_int_equal(ferror(file), 0);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(size, end);
    assert_int_equal(strlen(text), size);
    for (int i = 0; i < LINES; i++) {
        const size_t length = (size_t)snprintf(line, sizeof line, "line %d\n", i);
        assert_memory_equal(text + at, line, length);
        at += length;
    }
    assert_int_equal(at, size);
    free(text);
}

TEST(is_empty_at_first) {
    FREED char *text;
    size_t size;
    FILE *file = memory_stream(&text, &size);
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(size, 0);
    assert_string_equal(text, "");
}

/* Also where memory is there again later, and for whatever function wrote: none of them is checked for its result. */
TEST(tells_that_memory_ran_out) {
    FREED char *text;
    size_t size;
    FILE *file = memory_stream(&text, &size);
    assert_non_null(file);
    write_lines(file, 0, LINES / 3);
    memory_is_short = true;
    write_lines(file, LINES / 3, 2 * LINES / 3);
    memory_is_short = false;
    write_lines(file, 2 * LINES / 3, LINES);
    assert_int_not_equal(ferror(file), 0);
    assert_int_not_equal(fclose(file), 0);
    assert_int_equal(strlen(text), size);
    assert_null(strstr(text, "line 2999"));
}

RUN_TESTS(NULL, NULL)
