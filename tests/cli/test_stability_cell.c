/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of maps as they are named on the command line, and found in the table. */
#include "testing.h"

#include "cli/runs.h"
#include "base/file.h"

#define HEADER "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,frame,body,value,unit\n"

TEST(a_cell_has_a_map_a_method_and_two_numbers) {
    static const struct {
        const char *text, *map, *method;
        double x, y;
    } cases[] = {{"a:engine:1,2", "a", "engine", 1, 2},
                 {"spin_x:engine:k=10,warm=off:-2.5,1e3", "spin_x", "engine:k=10,warm=off", -2.5, 1000},
                 {"a:pair-net:network=b:c.npz:0,0", "a", "pair-net:network=b:c.npz", 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        StabilityCell cell;
        assert_ok(stability_cell_parse(&cell, cases[i].text, &error), error);
        assert_string_equal(cell.map, cases[i].map);
        assert_string_equal(cell.method, cases[i].method);
        assert_true(cell.x == cases[i].x && cell.y == cases[i].y);
    }
}

TEST(what_is_no_cell_is_refused) {
    char map[300], method[300];
    snprintf(map, sizeof map, "%0*d:engine:1,2", CSV_NAME_SIZE, 1);
    snprintf(method, sizeof method, "a:%0*d:1,2", METHOD_TEXT_SIZE, 1);
    const char *const texts[] = {"",
                                 "a",
                                 "a:1,2",
                                 ":engine:1,2",
                                 "a::1,2",
                                 "a:engine:",
                                 "a:engine:1",
                                 "a:engine:1,",
                                 "a:engine:,1",
                                 "a:engine:1,2,3",
                                 "a:engine:x,y",
                                 "a:engine:1,nan",
                                 "a:engine:1,inf",
                                 "a:engine:1 ,2",
                                 map,
                                 method};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        StabilityCell cell;
        error = (Error){0};
        if (stability_cell_parse(&cell, texts[i], &error)) fail_msg("'%s' is taken", texts[i]);
        assert_error(error, ERROR_INPUT, "is not MAP:METHOD:X,Y");
    }
    /* One character less has room. */
    StabilityCell cell;
    snprintf(map, sizeof map, "%0*d:engine:1,2", CSV_NAME_SIZE - 1, 1);
    snprintf(method, sizeof method, "a:%0*d:1,2", METHOD_TEXT_SIZE - 1, 1);
    assert_ok(stability_cell_parse(&cell, map, &error) && stability_cell_parse(&cell, method, &error), error);
    assert_int_equal(strlen(cell.method), METHOD_TEXT_SIZE - 1);
}

static CsvTable table;

FIXTURE(read_table) {
    static const char text[] = HEADER "a,engine,,h,,10,i,,1,falls,9,1,1,m\na,engine,,h,,10.05,i,,1,sinks,9,1,1,m\n"
                                      "a,engine,,h,,-20,i,,0,falls,9,1,1,m\n"
                                      "a,engine,k=4,h,,10,i,,1,not applicable,,,,\n"
                                      "a,momentum,,h,,10,i,,1,sways,9,1,1,J\na,nncg,,h,,10,i,,1,settles,9,1,1,J\n"
                                      "b,engine,,h,,10.05,i,,1,settles,9,1,1,J\n";
    assert_ok(file_write_soon(temporary_path("maps.csv"), text, strlen(text), &error), error);
    assert_ok(csv_table_read_from(&table, temporary_folder, &map_layout, &error), error);
}

FIXTURE(free_table) { csv_table_free(&table); }

/* The row of the table, from 0; -1: there is none, and the error has this text. */
static void expect_row(const char *text, int row, const char *message) {
    StabilityCell cell;
    Error error = {0};
    assert_ok(stability_cell_parse(&cell, text, &error), error);
    const MapCell *found = stability_cell_find(&table, &cell, &error);
    if (row >= 0) {
        assert_ok(found != NULL, error);
        assert_int_equal(found - map_cell(&table, 0), row);
    } else {
        assert_null(found);
        assert_error(error, ERROR_INPUT, message);
    }
}

TEST(the_nearest_cell_within_a_percent_is_found) {
    expect_row("a:engine:10,1", 0, NULL);
    expect_row("a:engine:10.02,1", 0, NULL);
    expect_row("a:engine:10.03,1", 1, NULL);
    expect_row("a:engine:-20.1,0", 2, NULL);
    expect_row("a:engine:k=4:10,1", 3, NULL);
    expect_row("b:engine:10,1", 6, NULL);
    expect_row("a:engine:10.2,1", -1, "map a has no cell 10.2,1 of method engine; its X: 10, 10.05, -20; its Y: 1, 0");
    expect_row("a:engine:-20,0.001", -1, "map a has no cell");
    expect_row("c:engine:10,1", -1, "there is no map c in");
    expect_row("c:engine:10,1", -1, "; its maps: a, b");
    expect_row("a:engine:k=5:10,1", -1,
               "map a has no method engine:k=5; its methods: engine, engine:k=4, momentum, nncg");
}

TEST(the_first_method_that_holds_there_is_the_holder) {
    assert_ptr_equal(stability_cell_holder(&table, map_cell(&table, 0)), map_cell(&table, 4));
    assert_null(stability_cell_holder(&table, map_cell(&table, 1))); /* in map b only */
    assert_null(stability_cell_holder(&table, map_cell(&table, 2)));
}

RUN_TESTS(read_table, free_table)
