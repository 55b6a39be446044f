/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of maps: what holds there, and the runs that show what happened. The verdicts are made up. */
#include "testing.h"

#include "base/file.h"
#include "cli/larger_commands.h"

#define HEADER "map,method,setting,x_parameter,x_unit,x,y_parameter,y_unit,y,verdict,frame,body,value,unit\n"

static CsvTable table;

FIXTURE(read_table) {
    static const char text[] = HEADER "a,engine,,h,,10,i,,1,falls,9,1,1,m\na,engine,,h,,10.05,i,,1,sinks,9,1,1,m\n"
                                      "a,engine,,h,,-20,i,,0,falls,9,1,1,m\n"
                                      "a,engine,k=4,h,,10,i,,1,not applicable,,,,\n"
                                      "a,momentum,,h,,10,i,,1,moves,9,1,1,J\na,nncg,,h,,10,i,,1,settles,9,1,1,J\n"
                                      "b,engine,,h,,10.05,i,,1,settles,9,1,1,J\n";
    assert_ok(file_write_soon(temporary_path("maps.csv"), text, strlen(text), &error), error);
    assert_ok(csv_table_read_from(&table, temporary_folder, &map_layout, &error), error);
}

FIXTURE(free_table) { csv_table_free(&table); }

TEST(the_first_method_that_holds_there_is_the_holder) {
    assert_ptr_equal(stability_cell_holder(&table, map_cell(&table, 0)), map_cell(&table, 4));
    assert_null(stability_cell_holder(&table, map_cell(&table, 1))); /* in map b only */
    assert_null(stability_cell_holder(&table, map_cell(&table, 2)));
}

static const CellMap map = {"m", SOURCE_DIR "/scenes/stability/time_step.yaml", "rate", "height"};

static MapCell cell_of(const char *method, double rate, double height, Verdict verdict, double frame) {
    return (MapCell){.map = "m",
                     .method = method,
                     .setting = "",
                     .x_parameter = "rate",
                     .x_unit = "Hz",
                     .x = rate,
                     .y_parameter = "height",
                     .y_unit = "",
                     .y = height,
                     .verdict = (int)verdict,
                     .frame = frame,
                     .body = 1,
                     .value = 0.5,
                     .unit = "m"};
}

/* Runs the cell, and expects so many frames of each run, of the holder first. */
static void expect_frames(const MapCell *holder, const MapCell *cell, int count, int of_first, int of_last) {
    CellRuns runs;
    Error error = {0};
    assert_ok(cell_runs_make(&runs, &map, holder, cell, "m", NULL, &error), error);
    assert_int_equal(runs.panels.count, count);
    assert_int_equal(runs.panels.runs[0]->frames, of_first);
    assert_int_equal(runs.panels.runs[count - 1]->frames, of_last);
    cell_runs_free(&runs);
}

/* 20 Hz: frames 0 to 4, and those of three seconds. */
TEST(runs_go_on_for_three_seconds) {
    const MapCell cell = cell_of("engine", 20, 2, VERDICT_FALLS, 4),
                  holder = cell_of("nncg", 20, 2, VERDICT_SETTLES, 2);
    expect_frames(NULL, &cell, 1, 65, 65);
    expect_frames(&holder, &cell, 2, 65, 65);
    expect_frames(&holder, &holder, 1, 63, 63); /* it holds, and is alone */
}

/* 480 Hz: every eighth frame, up to step 2 + 3 * 480. */
TEST(no_more_than_sixty_frames_a_second_are_kept) {
    const MapCell cell = cell_of("momentum", 480, 2, VERDICT_SETTLES, 2);
    expect_frames(NULL, &cell, 1, 181, 181);
}

/* The run that leaves the finite numbers in step 3 ends with frame 2; one that holds goes on beside it. */
TEST(what_is_no_more_finite_ends_before) {
    const MapCell cell = cell_of("nncg", 20, 2, VERDICT_NON_FINITE, 3);
    const MapCell holder = cell_of("momentum", 20, 2, VERDICT_SETTLES, 2);
    expect_frames(&holder, &cell, 2, 64, 3);
    expect_frames(NULL, &cell, 1, 3, 3);
}

TEST(a_map_without_a_scene_is_refused) {
    assert_ptr_equal(cell_map_find(&map, 1, "m", &error), &map);
    assert_refused(cell_map_find(&map, 1, "n", &error) != NULL, "map n has no scene");
}

RUN_TESTS(read_table, free_table)
