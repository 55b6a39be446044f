/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"
#include "files.h"

#include "studies/piece_tables.h"

static const CsvColumn columns[] = {{"x", CSV_INTEGER, .offset = 0, .maximum = 99}};
static const CsvLayout a_layout = CSV_LAYOUT("a", columns, int, .max_rows = 9),
                       ab_layout = CSV_LAYOUT("ab", columns, int, .max_rows = 9);
static const CsvLayout *const layouts[] = {&a_layout, &ab_layout};

/* The results of the pieces; NULL ends them. */
static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "piece %d", (int)piece);
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    (void)progress, (void)error;
    fputs(((const char *const *)context)[piece], results);
    return true;
}

static bool write_tables(const char *folder, const char **results, int count, const PieceGroup *groups, int group_count,
                         Error *error) {
    StudyKey key = {0};
    const PiecePlan plan = {.count = count, .describe = describe, .work = work, .context = results};
    Pieces pieces;
    const bool done = pieces_open(&pieces, folder, &key, &(Shard){0}, error) &&
                      pieces_do(&pieces, &plan, NULL, error) &&
                      piece_tables_write(&pieces, folder, layouts, 2, groups, group_count, error);
    return pieces_end(&pieces, &(Error){0}) && done;
}

static void assert_table(const char *folder, const char *name, const char *expected) {
    assert_file(printed("%s/%s.csv", folder, name), expected);
}

TEST(rows_have_the_order_of_pieces_and_sections) {
    const char *folder = printed("%s", temporary_path("tables"));
    const char *results[] = {"a:1\n# a:9\nab:2\na:3\n#\n", "",     "# 8\nab:4\n", "a/1:11\na/0:10\nab:5\n",
                             "a/0:20\na/1:21\n",           "a:6\n"};
    const PieceGroup groups[] = {{0, 3, 0}, {3, 2, 2}, {5, 1, 0}};
    assert_ok(write_tables(folder, results, 6, groups, 3, &error), error);
    assert_table(folder, "a", "x\n1\n3\n10\n20\n11\n21\n6\n");
    assert_table(folder, "ab", "x\n2\n4\n5\n");
    assert_ok(write_tables(folder, results, 3, NULL, 0, &error), error);
    assert_table(folder, "a", "x\n1\n3\n");
}

TEST(lines_of_no_table_are_refused) {
    const char *folder = printed("%s", temporary_path("foreign"));
    static const char *const wrong[] = {"b:1\n", "a1\n",    "a/0:1\n", "a/-2:1\n", "a/x:1\n",
                                        "a:1",   "abc:1\n", ":1\n",    "\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        error = (Error){0};
        const char *results[] = {wrong[i]};
        if (write_tables(folder, results, 1, NULL, 0, &error)) fail_msg("'%s' is taken", wrong[i]);
        assert_int_equal(error.kind, ERROR_SYSTEM);
    }
}

TEST(a_row_is_a_line_with_the_tables_name) {
    FREED char *text = NULL;
    size_t size;
    FILE *results = open_memstream(&text, &size);
    assert_ok(piece_tables_print(results, &a_layout, -1, &(int){7}, &error), error);
    assert_ok(piece_tables_print(results, &ab_layout, 3, &(int){8}, &error), error);
    fclose(results);
    assert_string_equal(text, "a:7\nab/3:8\n");
}

RUN_TESTS(NULL, NULL)
