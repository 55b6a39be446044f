/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whichever allocation fails, of the tree or of libyaml: a file is not called wrong, and no value is lost. */
#include "library_allocations.h"

#include "base/yaml.h"

static const char text[] =
    "# a comment\ndt: 1/60\nbodies:\n  - {size: [1, 1], name: \"in quotes\"}\n  - {size: 'two'}\n"
    "block: |\n  several\n  lines\nempty:\n";
static const char *path;

static bool read_tree(Error *error) {
    static const char *const scalars[] = {"dt",    "1/60",      "bodies", "size", "1",     "1",
                                          "name",  "in quotes", "size",   "two",  "block", "several\nlines\n",
                                          "empty", ""};
    YamlTree tree;
    if (!yaml_read(&tree, path, error)) return false;
    int found = 0;
    for (int i = 0; i < tree.node_count; i++)
        if (tree.nodes[i].kind == YAML_SCALAR) assert_string_equal(yaml_text(&tree, i), scalars[found++]);
    assert_int_equal(found, sizeof scalars / sizeof *scalars);
    yaml_tree_free(&tree);
    return true;
}

TEST(a_lack_of_memory_is_no_mistake_in_the_file) {
    path = write_bytes(temporary_path("a.yaml"), text, strlen(text));
    assert_memory_is_named(read_tree);
}

static bool read_broken(Error *error) {
    YamlTree tree;
    Error failure = {0};
    assert_false(yaml_read(&tree, path, &failure));
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind == ERROR_INPUT && strstr(failure.message, "expected ',' or ']'") != NULL;
}

TEST(mistakes_keep_their_words) {
    static const char broken[] = "a: [1, 2]\nb: [[1 }\n";
    path = write_bytes(temporary_path("b.yaml"), broken, strlen(broken));
    assert_memory_is_named(read_broken);
}

RUN_TESTS(NULL, NULL)
