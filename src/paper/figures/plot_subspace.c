/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A panel for each scene: distance from the offline engine's runs over the time of a step. Subspace with its floor and its
   linear term, and the engines that it replaces. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_data.h"
#include "paper/systems/subspace_study.h"
#include "subspace_training/subspace_training.h"

#include <math.h>
#include <string.h>

/* mm */
static const double panel_height = 38, left = 13, right = 3, bottom = 23.5, top = 6, gap = 4, row_gap = 14;

enum { COLUMNS = 2 };

/* m: below this a distance is rounding; the runs were recorded by interior, whose own distance is 0. */
static const double least_distance = 1e-4;

typedef enum Series { NETWORK, LINEAR, FLOOR, ENGINE, INTERIOR, CONVERGED, LOOKS } Series;

static const char *const engines[LOOKS] = {
    [ENGINE] = "engine", [INTERIOR] = SUBSPACE_OFFLINE, [CONVERGED] = SUBSPACE_STUDY_OFFLINE};

typedef struct Picture {
    GnuplotPage *page;
    const SubspaceStudyRow *rows;
    int count;
    GnuplotAxis time, distance;
} Picture;

static GnuplotLook look_of(int series) {
    static const char *const names[LOOKS] = {"subspace, with 8, 32 and 128 components", "its linear term alone",
                                             "floor: what the components lose",         "engine",
                                             "interior, which recorded the runs",       "converged solution"};
    const GnuplotLook look = gnuplot_look(series, names[series]);
    return engines[series] != NULL ? gnuplot_look_marks(look) : look;
}

/* NAN: the row is not of the series. */
static double distance_of(const SubspaceStudyRow *row, int series) {
    if (engines[series] != NULL && strcmp(row->method, engines[series]) != 0) return NAN;
    if (engines[series] == NULL && row->components == 0) return NAN;
    return fmax(series == LINEAR ? row->linear_rms : series == FLOOR ? row->floor_rms : row->rms, least_distance);
}

static void choose_axes(Picture *picture) {
    GnuplotRange time = gnuplot_range(), distance = gnuplot_range();
    for (int i = 0; i < picture->count; i++) {
        gnuplot_range_include(&time, picture->rows[i].us_step);
        for (int series = 0; series < LOOKS; series++)
            gnuplot_range_include(&distance, distance_of(&picture->rows[i], series));
    }
    picture->time = gnuplot_axis(time, 1e-3, 1e6, false);
    picture->distance = gnuplot_axis(distance, least_distance, 1e3, false);
}

static void draw_series(const Picture *picture, int scene, int series) {
    const GnuplotLook look = look_of(series);
    gnuplot_series_begin(picture->page);
    for (int i = 0; i < picture->count; i++) {
        const SubspaceStudyRow *row = &picture->rows[i];
        const double distance = distance_of(row, series);
        if (row->scene != scene || isnan(distance) || isnan(row->us_step)) continue;
        gnuplot_point(picture->page, gnuplot_axis_clamp(picture->page, &picture->time, row->us_step),
                      gnuplot_axis_clamp(picture->page, &picture->distance, distance));
    }
    gnuplot_series_end(picture->page, &look);
}

/* place: of the panel, from the upper left one. */
static void draw_panel(const Picture *picture, int scene, int place, int rows) {
    static const char *const titles[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    const int column = place % COLUMNS, row = place / COLUMNS;
    const double width = (FIGURE_PAGE_WIDTH - left - right - gap) / COLUMNS;
    const GnuplotBox box = {left + column * (width + gap), bottom + (rows - 1 - row) * (panel_height + row_gap), width,
                            panel_height};
    gnuplot_panel_begin(picture->page, box, titles[scene]);
    gnuplot_log_axis(picture->page, 'x', &picture->time, "Time of a step (µs)");
    gnuplot_log_axis(picture->page, 'y', &picture->distance, column == 0 ? "Distance (m)" : NULL);
    for (int series = LOOKS - 1; series >= 0; series--) draw_series(picture, scene, series);
    gnuplot_panel_end(picture->page);
}

static bool has_rows(const Picture *picture, int scene) {
    for (int i = 0; i < picture->count; i++)
        if (picture->rows[i].scene == scene) return true;
    return false;
}

static void draw(Picture *picture) {
    GnuplotLook looks[LOOKS];
    int scenes = 0, place = 0;
    for (int scene = 0; scene < PAPER_SCENES; scene++) scenes += has_rows(picture, scene);
    if (scenes == 0) return;
    const int rows = (scenes + COLUMNS - 1) / COLUMNS;
    choose_axes(picture);
    gnuplot_page_begin(picture->page, FIGURE_PAGE_WIDTH, bottom + rows * (panel_height + row_gap) - row_gap + top);
    for (int scene = 0; scene < PAPER_SCENES; scene++)
        if (has_rows(picture, scene)) draw_panel(picture, scene, place++, rows);
    for (int series = 0; series < LOOKS; series++) looks[series] = look_of(series);
    gnuplot_legend(picture->page, looks, LOOKS, 2, left, 10);
    fprintf(picture->page->caption,
            "subspace on held-out launches: distance of positions from the offline engine's runs (RMS over bodies and "
            "frames) over the time of a step. With it: its linear term alone, the floor (the recorded poses reduced to "
            "the components), and engines, whose time is the whole step. 0.0001 m: at most.");
    gnuplot_page_end(picture->page);
}

bool plot_subspace(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &subspace_study_layout, error)) return false;
    Picture picture = {.page = page, .rows = table.rows, .count = table.count};
    draw(&picture);
    csv_table_free(&table);
    return true;
}
