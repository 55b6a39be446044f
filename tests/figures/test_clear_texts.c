/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All texts of all figures can be read, at the least, the usual and the largest size. */
#include "testing.h"
#include "files.h"
#include "made.h"

#include "figures/clear_texts.h"
#include "figures/run_figure.h"
#include "paper/paper_report.h"
#include "pictures/mesa.h"
#include "studies/chart_plot.h"
#include "studies/equal_time.h"
#include "studies/stability_drawn.h"

#include <sys/stat.h>

#define SAMPLE SOURCE_DIR "/tests/studies/chart.csv"

static Faults faults;

/* What studies draw is checked instead of written. */
bool __wrap_sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error);
bool __wrap_sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error) {
    (void)last, (void)error;
    snprintf(faults.figure, sizeof faults.figure, "%s", stem + file_folder_length(stem));
    check_texts(sketch, &faults);
    return true;
}

/* Widths and font sizes; the first three are drawn always, others may be refused, with a message that says what is
   needed. */
static const double sizes[][2] = {{85, 8}, {174, 8}, {400, 8},  {40, 8},  {40, 5},
                                  {60, 8}, {85, 14}, {174, 14}, {400, 14}};
enum { SIZES = sizeof sizes / sizeof *sizes, USUAL = 3, LEAST = 4 };

/* At the first `drawn` sizes without exception. */
static void draw_at_sizes(const FigureKind *kind, FigureSpec *spec, int count, int drawn) {
    for (int i = 0; i < count; i++) {
        Error error = {0};
        Sketch sketch = {0};
        spec->width = sizes[i][0], spec->points = sizes[i][1];
        snprintf(faults.figure, sizeof faults.figure, "%s of %d runs of %s at %g mm, %g points", kind->name,
                 spec->run_count, spec->runs[0]->scene, spec->width, spec->points);
        if (figure_draw(kind, &sketch, spec, &error))
            check_texts(&sketch, &faults);
        else if (i < drawn || error.kind != ERROR_INPUT || strstr(error.message, "mm") == NULL)
            fault(&faults, "%s", error.message);
        sketch_free(&sketch);
    }
}

static Trajectory *read_run(const char *scene, const char *method) {
    char path[512];
    Error error = {0};
    snprintf(path, sizeof path, SOURCE_DIR "/golden/trajectories/%s-%s.npz", scene, method);
    Trajectory *run = trajectory_read(path, &error);
    assert_ok(run != NULL, error);
    return run;
}

static void free_runs(Trajectory **runs, int count) {
    for (int i = 0; i < count; i++) trajectory_destroy(runs[i]);
}

TEST(figures_of_runs) {
    static const char *const scenes[] = {"stack", "pyramid_settled"};
    for (int scene = 0; scene < 2; scene++) {
        Trajectory *runs[] = {read_run(scenes[scene], "engine"), read_run(scenes[scene], "pair-net"),
                              read_run(scenes[scene], "engine")};
        for (int i = 0; figure_kinds()[i] != NULL; i++) {
            const FigureKind *kind = figure_kinds()[i];
            FigureSpec spec = spec_of(runs, kind->max_runs < 3 ? kind->max_runs : 3);
            spec.dpi = 50;
            draw_at_sizes(kind, &spec, SIZES, USUAL);
        }
        free_runs(runs, 3);
    }
    assert_clear(&faults);
}

/* 40 mm are documented as the least width: at the font size by default, every kind has room for as few runs as it
   takes. */
TEST(the_least_width_is_enough) {
    Trajectory *runs[] = {read_run("stack", "engine"), read_run("stack", "pair-net")};
    for (int i = 0; figure_kinds()[i] != NULL; i++) {
        const FigureKind *kind = figure_kinds()[i];
        FigureSpec spec = spec_of(runs, kind->min_runs);
        spec.dpi = 50, spec.moments = 2;
        draw_at_sizes(kind, &spec, LEAST, LEAST);
    }
    free_runs(runs, 2);
    assert_clear(&faults);
}

static void make_folder(void) {
    remove_temporary_folder();
    temporary_path("");
    mkdir(temporary_folder, 0700);
}

/* A table with many methods of long names, with all notes. */
static const char *crowded_chart(void) {
    const char *path = temporary_path("crowded.csv");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("scene,method,setting,protocol,phase,launches,us_solver,us_step,error_"
          "mean,"
          "error_median,error_p95,error_worst,share_right,penetration_max,drift,energy,moved,cpu,us_engine\n",
          file);
    for (int i = 0; i < 60; i++)
        fprintf(file, "crowded,method-with-quite-a-long-name-to-be-cut-%d,k=%d,closed,%s,9,%d,,%s,,,,,,,,,A,\n", i % 15,
                5 * (1 + i), i % 2 == 0 ? "impact" : "after", 9 + i, i % 7 == 0 ? "" : "0.01");
    fputs("crowded,engine,k=10,closed,impact,9,12,,0.02,,,,,,,,,A,\n"
          "crowded,soft-step,substeps=4,closed,impact,9,14,,0.03,,,,,,,,,A,\n",
          file);
    assert_int_equal(fclose(file), 0);
    return path;
}

TEST(charts) {
    EqualTimeFigure figure;
    make_folder();
    for (int size = 0; size <= CHART_SLIDE; size++)
        for (int words = 0; words < 2; words++) {
            const ChartLook look = {.size = (ChartSize)size, .words = words == 1};
            assert_ok(chart_plot(SAMPLE, "pyramid_settled", temporary_folder, &look, &error), error);
            assert_ok(chart_plot(crowded_chart(), "crowded", temporary_folder, &look, &error), error);
        }
    assert_ok(equal_time_plot(SOURCE_DIR "/tests/studies/equal_time.csv", temporary_folder, &figure, &error), error);
    assert_ok(equal_time_plot(SOURCE_DIR "/tests/studies/chart.csv", temporary_folder, &figure, &error), error);
    assert_clear(&faults);
}

/* Maps from a single cell to many panels; borders of all studies and of one. */
TEST(maps_and_borders) {
    static const int shapes[][3] = {{1, 1, 1}, {1, 8, 2}, {3, 4, 4}, {4, 12, 12}, {9, 30, 20}};
    char *borders = text_of(SOURCE_DIR "/golden/stability.csv");
    for (int i = 0; i < 5; i++) {
        FREED char *maps = make_map(shapes[i][0], shapes[i][1], shapes[i][2]);
        start_afresh(maps, i % 2 == 0 ? borders : BORDERS ONE_BORDER);
        draw();
    }
    free(borders);
    assert_clear(&faults);
}

TEST(figures_of_the_paper) {
    static const char *const tables[] = {"table1", "networks", "rates", "closed_loop", "laws", "transfer"};
    make_folder();
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        char name[64], path[512];
        size_t size;
        snprintf(name, sizeof name, "%s.csv", tables[i]);
        snprintf(path, sizeof path, SOURCE_DIR "/tests/paper/figures/%s", name);
        FREED char *text = read_whole(path, &size);
        write_bytes(temporary_path(name), text, size);
    }
    assert_ok(plots_draw(temporary_folder, NULL, &error), error);
    assert_ok(illustrations_draw(SOURCE_DIR "/scenes", temporary_folder, &error), error);
    assert_clear(&faults);
}

/* Two texts and a line, which are in order. */
static void begin(Sketch *sketch) {
    const Pen pen = pen_line(INK, 1, NULL);
    sketch_begin(sketch, 60, 20);
    sketch_text(sketch, (Point){10, 5}, &(TextStyle){8, TEXT_LEFT, INK, 0, false}, "engine");
    sketch_text(sketch, (Point){10, 12}, &(TextStyle){8, TEXT_LEFT, INK, 90, false}, "1.65");
    sketch_line(sketch, (Point){30, 0}, (Point){30, 20}, &pen);
}

static void expect_fault(Sketch *sketch, const char *words) {
    Faults found = {.figure = "made"};
    check_texts(sketch, &found);
    if (found.count != 1 || strstr(found.text, words) == NULL)
        fail_msg("%d faults, not one that says \"%s\": %s", found.count, words, found.text);
    sketch_free(sketch);
}

static void expect_none(Sketch *sketch) {
    Faults found = {.figure = "made"};
    check_texts(sketch, &found);
    assert_clear(&found);
    sketch_free(sketch);
}

/* Each fault, made on purpose. */
TEST(faults_are_found) {
    const Pen pen = pen_line(INK, 1, NULL), pale = pen_line(0xEEEEEE, 1, NULL), band = pen_fill(0xD3D8DF, 1, NO_COLOUR);
    const TextStyle style = {8, TEXT_LEFT, INK, 0, false}, soft = {8, TEXT_LEFT, INK_SOFT, 0, false};
    Sketch sketch;
    begin(&sketch), expect_none(&sketch);
    begin(&sketch), sketch.marks[1].at = sketch.marks[0].at, expect_fault(&sketch, "\"1.65\" covers \"engine\"");
    begin(&sketch), sketch.marks[0].at.x = -1, expect_fault(&sketch, "\"engine\" is cut by the page");
    begin(&sketch), sketch.marks[0].at.y = 0.5, expect_fault(&sketch, "\"engine\" is cut by the page");
    begin(&sketch), sketch.marks[0].at.x = 27, expect_fault(&sketch, "\"engine\" is crossed by a line");
    begin(&sketch), sketch.marks[1].at.x = 30, expect_fault(&sketch, "\"1.65\" is crossed by a line");
    begin(&sketch), sketch_text(&sketch, (Point){40, 5}, &style, "pair-n\xE2\x80\xA6"),
        expect_fault(&sketch, "shortened");
    begin(&sketch), sketch_text(&sketch, (Point){40, 5}, &(TextStyle){3, TEXT_LEFT, INK, 0, false}, "small");
    expect_fault(&sketch, "\"small\" has 3.0 points");
    begin(&sketch), sketch_text(&sketch, (Point){40, 5}, &style, "1.65");
    sketch_line(&sketch, (Point){37, 5}, (Point){39.5, 5}, &pen), expect_fault(&sketch, "read with a minus sign");
    begin(&sketch), sketch_text(&sketch, (Point){40, 5}, &style, "1.65");
    sketch_line(&sketch, (Point){37, 2}, (Point){39.5, 4}, &pen), expect_none(&sketch);
    begin(&sketch), sketch_text(&sketch, (Point){40, 5}, &soft, "impact"), expect_none(&sketch);
    begin(&sketch), sketch_rectangle(&sketch, (Point){38, 1}, (Point){58, 9}, &band);
    sketch_text(&sketch, (Point){40, 5}, &soft, "impact"), expect_fault(&sketch, "\"impact\" has a contrast of 3.5");
    begin(&sketch), sketch_line(&sketch, (Point){0, 5}, (Point){60, 5}, &pale), expect_none(&sketch);
}

RUN_TESTS(NULL, NULL)
