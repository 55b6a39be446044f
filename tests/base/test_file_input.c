/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Standard input is read to its end, up to a limit. */
#include "owned.h"

#include "base/file.h"

/* Makes these bytes, which a pipe holds, the standard input. */
static void give(size_t size) {
    static char bytes[60000];
    int ends[2];
    memset(bytes, 'x', sizeof bytes);
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], bytes, size), size);
    close(ends[1]);
    assert_int_equal(dup2(ends[0], STDIN_FILENO), STDIN_FILENO);
    close(ends[0]);
}

TEST(all_of_it_is_read) {
    const size_t sizes[] = {0, 1, 60000};
    for (int i = 0; i < 3; i++) {
        size_t size;
        give(sizes[i]);
        FREED char *data = file_read_input(60000, &size, &error);
        assert_ok(data != NULL, error);
        assert_int_equal(size, sizes[i]);
        assert_int_equal(strlen(data), size);
    }
}

TEST(more_than_the_limit_is_refused) {
    size_t size;
    give(101);
    assert_refused(file_read_input(100, &size, &error), "standard input: error: larger than 100 bytes");
}

TEST(what_cannot_be_read_is_an_error) {
    size_t size;
    close(STDIN_FILENO);
    assert_null(file_read_input(100, &size, &error));
    assert_error(error, ERROR_SYSTEM, "standard input: error: cannot read: ");
}

RUN_TESTS(NULL, NULL)
