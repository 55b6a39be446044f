/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "files.h"
#include "charts.h"

#include "studies/chart_table.h"

static const ChartRow full = {.scene = "stack",
                              .method = "momentum",
                              .setting = "k=20,warm=off",
                              .protocol = PROTOCOL_CLOSED,
                              .phase = PHASE_AFTER,
                              .launches = 40,
                              .us_solver = 10.5,
                              .us_step = 52.5,
                              .error_mean = 0.0625,
                              .error_median = 0.03125,
                              .error_p95 = 0.25,
                              .error_worst = 0.125,
                              .share_right = 0.5,
                              .penetration_max = 0.001,
                              .drift = -0.00025,
                              .energy = -2.5,
                              .moved = 1.5,
                              .cpu = "AMD EPYC",
                              .us_engine = NAN,
                              .signorini = 0.5,
                              .cone = 0.25,
                              .dissipation = 0.75,
                              .rollout_mse = 0.125,
                              .floor = 0.0625};

static ChartRow bare(void) {
    ChartRow row = {.scene = "stack", .method = "playback", .setting = "", .cpu = ""};
    for (double *figure = &row.us_solver; figure <= &row.moved; figure++) *figure = NAN;
    for (double *figure = &row.us_engine; figure <= &row.floor; figure++) *figure = NAN;
    row.us_engine = 1.25;
    return row;
}

TEST(rows_are_written_in_the_order_of_the_header) {
    const ChartRow rows[] = {full, bare()};
    const char *path = temporary_path("written.csv");
    assert_ok(csv_table_write(path, &chart_layout, rows, 2, &error), error);
    assert_file(path, CHART_HEADER
                ",cpu,us_engine,signorini,cone,dissipation,rollout_mse,floor\nstack,momentum,\"k=20,warm="
                "off\",closed,"
                "after,40,10.5,52.5,"
                "0.0625,0.03125,0.25,0.125,0.5,0.001,-0.00025,-2.5,1.5,AMD EPYC,,0.5,0.25,0.75,0.125,0.0625\n"
                "stack,playback,,frozen,impact,0,,,,,,,,,,,,,1.25,,,,,\n");
}

static void assert_same_figure(double found, double expected) {
    if (isnan(expected))
        assert_true(isnan(found));
    else
        assert_true(found == expected);
}

static void assert_same_row(const ChartRow *found, const ChartRow *expected) {
    assert_string_equal(found->scene, expected->scene);
    assert_string_equal(found->method, expected->method);
    assert_string_equal(found->setting, expected->setting);
    assert_int_equal(found->protocol, expected->protocol);
    assert_int_equal(found->phase, expected->phase);
    assert_int_equal(found->launches, expected->launches);
    const double *a = &found->us_solver, *b = &expected->us_solver;
    for (const double *end = &found->moved; a <= end; a++, b++) assert_same_figure(*a, *b);
    assert_string_equal(found->cpu, expected->cpu);
    const double *c = &found->us_engine, *d = &expected->us_engine;
    for (const double *end = &found->floor; c <= end; c++, d++) assert_same_figure(*c, *d);
}

TEST(written_tables_are_read_back) {
    ChartRow rows[] = {full, bare(), full};
    rows[2].phase = PHASE_REST;
    rows[2].method = "say \"k\", \\ and 'more'";
    const char *path = temporary_path("written.csv");
    assert_ok(csv_table_write(path, &chart_layout, rows, 3, &error), error);
    CsvTable table;
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    assert_int_equal(table.count, 3);
    for (int i = 0; i < 3; i++) assert_same_row(chart_row(&table, i), &rows[i]);
    csv_table_free(&table);
}

#define GOOD "stack,engine,k=10,closed,impact,40,5,50,0.5,,,,,,,,\n"

static void expect_refused(const char *path, const char *message) {
    Error error = {0};
    CsvTable table;
    assert_refused(csv_table_read(&table, path, &chart_layout, &error), message);
}

/* As twinbox wrote them before it named the processor; the column can be the last one only. */
TEST(the_processor_may_be_missing) {
    CsvTable table;
    assert_ok(csv_table_read(&table, write_chart(GOOD), &chart_layout, &error), error);
    assert_string_equal(chart_row(&table, 0)->cpu, "");
    assert_true(chart_row(&table, 0)->us_solver == 5);
    csv_table_free(&table);
    const char *path = temporary_path("first.csv");
    static const char text[] = "cpu," CHART_HEADER "\nAMD," GOOD;
    assert_ok(file_write(path, text, strlen(text), &error), error);
    expect_refused(path, "first.csv:1:1: error: column 1 must be 'scene' (got 'cpu')");
}

/* The kinds of the columns: csv/csv_table. */
TEST(broken_tables_are_refused_with_their_place) {
    static const struct {
        const char *lines, *message;
    } cases[] = {
        {"", "chart.csv:2:1: error: the table has no rows"},
        {GOOD GOOD, "chart.csv:3:1: error: the row repeats that of line 2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        expect_refused(write_chart(cases[i].lines), cases[i].message);
}

RUN_TESTS(NULL, NULL)
