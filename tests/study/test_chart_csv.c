/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "charts.h"

#include "study/chart_csv.h"

#include "common/file.h"

#include <math.h>

static const ChartRow full = {
    "stack", "momentum", "k=20,warm=off", PROTOCOL_CLOSED, PHASE_AFTER, 40,    10.5, 9.25,  11.75,
    52.5,    123456,     0.0625,          0.03125,         0.25,        0.125, 0.5,  0.001, -0.00025,
    -2.5,    1.5};

static ChartRow bare(void) {
    return (ChartRow){"stack",      "playback", "",  PROTOCOL_FROZEN,
                      PHASE_IMPACT, 0,          NAN, NAN,
                      NAN,          NAN,        NAN, NAN,
                      NAN,          NAN,        NAN, NAN,
                      NAN,          NAN,        NAN, NAN};
}

static void rows_are_written_in_the_order_of_the_header(void **state) {
    (void)state;
    Error error = {0};
    const ChartRow rows[] = {full, bare()};
    const char *path = temporary_path("written.csv");
    assert_ok(chart_csv_write(path, rows, 2, &error), error);
    size_t size;
    char *text = file_read(path, 10000, &size, &error);
    assert_ok(text != NULL, error);
    assert_string_equal(text,
                        CHART_HEADER "stack,momentum,\"k=20,warm=off\",closed,after,40,10.5,9.25,11.75,52.5,123456,"
                                     "0.0625,0.03125,0.25,0.125,0.5,0.001,-0.00025,-2.5,1.5\n"
                                     "stack,playback,,frozen,impact,0,,,,,,,,,,,,,,\n");
    free(text);
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
}

static void written_tables_are_read_back(void **state) {
    (void)state;
    Error error = {0};
    ChartRow rows[] = {full, bare(), full};
    rows[2].phase = PHASE_REST;
    strcpy(rows[2].method, "say \"k\", \\ and 'more'");
    const char *path = temporary_path("written.csv");
    assert_ok(chart_csv_write(path, rows, 3, &error), error);
    ChartTable table;
    assert_ok(chart_csv_read(&table, path, &error), error);
    assert_int_equal(table.count, 3);
    for (int i = 0; i < 3; i++) assert_same_row(&table.rows[i], &rows[i]);
    chart_csv_free(&table);
}

static void unreadable_values_are_not_written(void **state) {
    (void)state;
    Error error = {0};
    const char *path = temporary_path("unwritten.csv");
    ChartRow row = full;
    row.error_mean = INFINITY;
    assert_false(chart_csv_write(path, &row, 1, &error));
    assert_error(error, ERROR_INPUT, "an infinite figure of stack, method momentum:k=20,warm=off");
    error = (Error){0};
    row = full;
    row.method[3] = '\n';
    assert_false(chart_csv_write(path, &row, 1, &error));
    assert_error(error, ERROR_INPUT, "a control character");
    assert_int_equal(access(path, F_OK), -1);
}

#define GOOD "stack,engine,k=10,closed,impact,40,5,4,6,50,,0.5,,,,,,,,\n"

static void broken_tables_are_refused_with_their_place(void **state) {
    (void)state;
    static const struct {
        const char *lines, *message;
    } cases[] = {
        {"", "chart.csv:2:1: error: the table has no rows"},
        {"stack,engine\n", "chart.csv:2:1: error: 2 fields, but the header has 20"},
        {GOOD GOOD, "chart.csv:3:1: error: this row is there twice"},
        {"stack,engine,k=10,open,impact,40,5,4,6,50,,0.5,,,,,,,,\n",
         "chart.csv:2:19: error: unknown protocol (got open)"},
        {"stack,engine,k=10,closed,,40,5,4,6,50,,0.5,,,,,,,,\n", "chart.csv:2:26: error: unknown phase (got nothing)"},
        {"stack,engine,k=10,closed,impact,-1,5,4,6,50,,0.5,,,,,,,,\n",
         "chart.csv:2:33: error: launches must be a whole number (got -1)"},
        {"stack,engine,k=10,closed,impact,40,five,4,6,50,,0.5,,,,,,,,\n",
         "chart.csv:2:36: error: us_solver must be a number (got five)"},
        {"stack,engine,k=10,closed,impact,40,5,4,6,50,,nan,,,,,,,,\n",
         "chart.csv:2:46: error: error_mean must be a number (got nan)"},
        {"stack,engine,k=10,closed,impact,40,5,4,6,50,,-0.5,,,,,,,,\n",
         "chart.csv:2:46: error: error_mean cannot be -0.5"},
        {"stack,engine,k=10,closed,impact,40,5,4,6,50,,0.5,,,-1,,,,,\n",
         "chart.csv:2:52: error: error_worst cannot be -1"},
        {"stack,engine,k=10,closed,impact,40,5,4,6,50,,0.5,,,,1.5,,,,\n",
         "chart.csv:2:53: error: share_right cannot be 1.5"},
        {"stack,engine,k=10,closed,impact,40,5,5.5,6,50,,0.5,,,,,,,,\n",
         "chart.csv:2:36: error: the median time is not within its quartiles"},
        {"stack,engine,k=10,closed,impact,40,,7,6,50,,0.5,,,,,,,,\n",
         "chart.csv:2:36: error: the median time is not within its quartiles"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error error = {0};
        ChartTable table;
        assert_false(chart_csv_read(&table, write_chart(cases[i].lines), &error));
        assert_error(error, ERROR_INPUT, cases[i].message);
    }
}

static void long_names_are_refused(void **state) {
    (void)state;
    char lines[512];
    snprintf(lines, sizeof lines, "%0128d,engine,k=10,closed,impact,40,5,4,6,50,,0.5,,,,,,,,\n", 0);
    Error error = {0};
    ChartTable table;
    assert_false(chart_csv_read(&table, write_chart(lines), &error));
    assert_error(error, ERROR_INPUT, "chart.csv:2:1: error: scene may have at most 127 bytes");
}

static void other_headers_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"scene,name\na,b\n", "other.csv:1:7: error: column 2 of a chart is method (got name)"},
        {"scene,method\na,b\n", "other.csv:1:1: error: a chart has 20 columns (got 2)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error error = {0};
        ChartTable table;
        const char *path = temporary_path("other.csv");
        assert_ok(file_write(path, cases[i].text, strlen(cases[i].text), &error), error);
        assert_false(chart_csv_read(&table, path, &error));
        assert_error(error, ERROR_INPUT, cases[i].message);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_written_in_the_order_of_the_header),
        cmocka_unit_test(written_tables_are_read_back),
        cmocka_unit_test(unreadable_values_are_not_written),
        cmocka_unit_test(broken_tables_are_refused_with_their_place),
        cmocka_unit_test(long_names_are_refused),
        cmocka_unit_test(other_headers_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
