/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables made by hand; their last column, `moved`, tells which rows are on the Pareto front. */
#include "testing.h"

#include "studies/chart_internal.h"

static CsvTable read_table(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/tests/studies/%s", SOURCE_DIR, name);
    Error error = {0};
    CsvTable table;
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    return table;
}

static void check_front(const char *name) {
    CsvTable table = read_table(name);
    bool on_front[16];
    assert_in_range(table.count, 1, 16);
    pareto_mark(table.rows, table.count, on_front);
    for (int i = 0; i < table.count; i++)
        if (on_front[i] != (chart_row(&table, i)->moved > 0))
            fail_msg("%s:%d: on the front: %d", name, i + 2, on_front[i]);
    csv_table_free(&table);
}

TEST(rows_that_nothing_beats_are_on_the_front) {
    check_front("pareto_overlap.csv"); /* overlapping and touching quartiles, equal errors, equal rows */
    check_front("pareto_missing.csv"); /* rows without time or error neither beat nor count, */
    check_front("pareto_apart.csv");   /* nor do those that solve nothing, or have no error by definition */
}

TEST(beating_has_a_direction) {
    CsvTable table = read_table("pareto_overlap.csv");
    const ChartRow *rows = table.rows;
    enum { ENGINE_10 = 1, MOMENTUM = 2, BLOCK = 3, NNCG = 4, SCENE_NET = 5, SUBSTEP_4 = 7, SUBSTEP_8 = 8 };
    assert_true(pareto_dominates(&rows[MOMENTUM], &rows[ENGINE_10]));
    assert_false(pareto_dominates(&rows[ENGINE_10], &rows[MOMENTUM]));
    assert_true(pareto_dominates(&rows[MOMENTUM], &rows[NNCG]));        /* equal errors: the faster */
    assert_false(pareto_dominates(&rows[MOMENTUM], &rows[BLOCK]));      /* overlap */
    assert_false(pareto_dominates(&rows[SCENE_NET], &rows[NNCG]));      /* equal times, however much better */
    assert_false(pareto_dominates(&rows[SCENE_NET], &rows[SUBSTEP_4])); /* quartiles touch at 10 */
    assert_true(pareto_dominates(&rows[SCENE_NET], &rows[SUBSTEP_8]));
    assert_false(pareto_dominates(&rows[NNCG], &rows[NNCG]));
    csv_table_free(&table);
}

RUN_TESTS(NULL, NULL)
