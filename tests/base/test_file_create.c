/* SPDX-License-Identifier: GPL-3.0-or-later */
/* New files: whole, and never over one that exists. */
#include "testing.h"

#include "files.h"

TEST(a_new_file_is_written) {
    const char *path = temporary_path("new");
    assert_ok(file_create(path, "text", 4, &error), error);
    assert_file(path, "text");
    assert_int_equal(count_files(temporary_folder, ""), 1);
    assert_int_equal(remove(path), 0);
}

TEST(a_file_that_exists_is_kept) {
    const char *path = write_bytes(temporary_path("old"), "mine", 4), *link = temporary_path("link");
    assert_int_equal(symlink("nothing", link), 0);
    const char *const taken[] = {path, link, temporary_path(".")};
    for (int i = 0; i < 3; i++) {
        assert_refused(file_create(taken[i], "text", 4, &error), "exists already, and is not overwritten");
    }
    assert_file(path, "mine");
    assert_int_equal(count_files(temporary_folder, ""), 2);
}

TEST(a_missing_folder_is_an_error) {
    assert_false(file_create(temporary_path("missing/new"), "text", 4, &error));
    assert_error(error, ERROR_SYSTEM, "missing/new: error: cannot write: its folder does not exist");
}

RUN_TESTS(NULL, NULL)
