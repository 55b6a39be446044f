/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a list of files holds, and what it refuses. (That no failed system call shortens it: tests/faults.) */
#include "testing.h"

#include "base/file.h"

static char root[256];

static const char *below(const char *name) {
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", root, name);
    return path;
}

static void make_file(const char *name) {
    Error error = {0};
    const char *path = below(name);
    assert_ok(file_make_directory(printed("%.*s", (int)file_folder_length(path), path), &error), error);
    write_bytes(path, "x", 1);
}

static void make_link(const char *target, const char *name) { assert_int_equal(symlink(target, below(name)), 0); }

/* tree/ has a.x, b/c.x, b/d/e.x; other files, hidden ones. outside.x lies beside it. */
FIXTURE(make_tree) {
    static const char *const names[] = {"tree/a.x",         "tree/b/c.x",  "tree/b/d/e.x",  "tree/a.y",
                                        "tree/b/.hidden.x", "tree/.b/f.x", "outside/far.x", "tree/b/x"};
    static int made;
    snprintf(root, sizeof root, "%s", temporary_path(printed("tree-%d", made++)));
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) make_file(names[i]);
}

static bool is_x(const char *name) { return strstr(name, ".x") != NULL; }

static void assert_lists(bool recursive, const char *wanted, size_t skipped) {
    Error error = {0};
    FolderList list;
    char found[512] = "";
    assert_ok(folder_list(&list, below("tree"), is_x, recursive, &error), error);
    for (size_t i = 0; i < list.count; i++) {
        size_t used = strlen(found);
        snprintf(found + used, sizeof found - used, "%s%s", i > 0 ? " " : "", list.names[i]);
    }
    assert_string_equal(found, wanted);
    assert_int_equal(list.skipped, skipped);
    folder_list_free(&list);
}

static void refuse(const char *folder, bool recursive, ErrorKind kind, const char *text) {
    Error error = {0};
    FolderList list;
    assert_false(folder_list(&list, below(folder), is_x, recursive, &error));
    assert_error(error, kind, text);
}

TEST_WITH(files_of_all_subfolders_are_listed, make_tree, NULL) { assert_lists(true, "a.x b/c.x b/d/e.x", 0); }

TEST_WITH(without_subfolders_their_files_are_counted, make_tree, NULL) { assert_lists(false, "a.x", 2); }

TEST_WITH(links_within_the_folder_add_no_folder_twice, make_tree, NULL) {
    make_link("a.x", "tree/link.x");
    make_link("b", "tree/same");
    make_link("..", "tree/b/up"); /* a walk that follows it does not end */
    make_link("nothing", "tree/nothing");
    assert_lists(true, "a.x b/c.x b/d/e.x link.x", 0);
}

TEST_WITH(links_out_of_the_folder_are_refused, make_tree, NULL) {
    make_link("../outside", "tree/far");
    refuse("tree", true, ERROR_INPUT, "tree/far: error: is a link to ");
    assert_lists(false, "a.x", 2); /* subfolders are left out anyway */
    assert_int_equal(unlink(below("tree/far")), 0);
    make_link("../outside/far.x", "tree/far.x");
    refuse("tree", true, ERROR_INPUT, "such links are not followed");
    refuse("tree", false, ERROR_INPUT, "such links are not followed");
    assert_int_equal(unlink(below("tree/far.x")), 0);
    /* A longer name is another folder. */
    make_file("tree-2/a.x");
    make_link("../tree-2", "tree/far");
    refuse("tree", true, ERROR_INPUT, "such links are not followed");
}

TEST_WITH(a_folder_that_does_not_exist_is_the_users_mistake, make_tree, NULL) {
    refuse("nowhere", true, ERROR_INPUT, "nowhere/: error: cannot be read");
    refuse("tree/a.x", true, ERROR_INPUT, "tree/a.x/: error: cannot be read");
}

RUN_TESTS(NULL, NULL)
