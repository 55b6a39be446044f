/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A panel for each scene: distance from the offline engine's runs over the time of a step. Subspace with its floor and its
   linear term, and the engines that it replaces. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_data.h"
#include "paper/systems/subspace_study.h"
#include "subspace_training/subspace_training.h"

#include <math.h>
#include <string.h>

/* mm */
static const double panel_height = 38, row_gap = 14, bottom = 23.5, top = 6;

enum { COLUMNS = 2 };

/* m: below this a distance is rounding; the runs were recorded by interior, whose own distance is 0. */
static const double least_distance = 1e-4;

typedef enum Series { NETWORK, LINEAR, FLOOR, ENGINE, INTERIOR, CONVERGED, LOOKS } Series;

static const char *const engines[LOOKS] = {
    [ENGINE] = "engine", [INTERIOR] = SUBSPACE_OFFLINE, [CONVERGED] = SUBSPACE_STUDY_OFFLINE};

typedef struct Picture {
    const SubspaceStudyRow *rows;
    int count, panels;
    int scenes[PAPER_SCENES]; /* [panels] that have rows */
    PlotGrid grid;
} Picture;

static PlotLook look_of(const void *of, int series) {
    static const char *const names[LOOKS] = {"subspace, with 8, 32 and 128 components", "its linear term alone",
                                             "floor: what the components lose",         "engine",
                                             "interior, which recorded the runs",       "converged solution"};
    (void)of;
    return engines[series] != NULL ? plot_look_marks(series, names[series]) : plot_look(series, names[series]);
}

/* NAN: the row is not of the series. */
static double distance_of(const SubspaceStudyRow *row, int series) {
    if (engines[series] != NULL && strcmp(row->method, engines[series]) != 0) return NAN;
    if (engines[series] == NULL && row->components == 0) return NAN;
    return fmax(series == LINEAR ? row->linear_rms : series == FLOOR ? row->floor_rms : row->rms, least_distance);
}

static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Picture *picture = of;
    const SubspaceStudyRow *row = &picture->rows[i];
    *out = (PlotPoint){row->us_step, distance_of(row, series), 0};
    return row->scene == picture->scenes[panel];
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    const Picture *picture = of;
    PlotRange time = plot_range(), distance = plot_range();
    for (int i = 0; i < picture->count; i++) {
        plot_range_include(&time, picture->rows[i].us_step);
        for (int series = 0; series < LOOKS; series++)
            plot_range_include(&distance, distance_of(&picture->rows[i], series));
    }
    out->box = plot_grid_box(&picture->grid, panel);
    out->title = titles[picture->scenes[panel]];
    out->x = plot_range_axis(time, 1e-3, 1e6, false, "Time of a step (µs)");
    out->y = plot_range_axis(distance, least_distance, 1e3, false, panel % COLUMNS == 0 ? "Distance (m)" : NULL);
}

/* The scenes with rows, in the order of the paper. */
static void find_scenes(Picture *picture) {
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        bool found = false;
        for (int i = 0; i < picture->count; i++) found |= picture->rows[i].scene == scene;
        if (found) picture->scenes[picture->panels++] = scene;
    }
}

bool plot_subspace(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &subspace_study_layout, error)) return false;
    Picture picture = {.rows = table.rows, .count = table.count};
    find_scenes(&picture);
    const int rows = (picture.panels + COLUMNS - 1) / COLUMNS;
    const double height = bottom + rows * (panel_height + row_gap) - row_gap + top;
    picture.grid = (PlotGrid){FIGURE_PAGE_WIDTH, height, 13, 3, bottom, top, COLUMNS, rows, 4, row_gap};
    const PlotSpec spec = {
        .of = &picture,
        .width = FIGURE_PAGE_WIDTH,
        .height = height,
        .panels = picture.panels,
        .series = LOOKS,
        .rows = picture.count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 2,
        .legend_left = picture.grid.left,
        .legend_top = 10,
        .caption =
            "subspace on held-out launches: distance of positions from the offline engine's runs (RMS over "
            "bodies and frames) over the time of a step. With it: its linear term alone, the floor (the recorded "
            "poses reduced to the components), and engines, whose time is the whole step. 0.0001 m: at most."};
    const bool drawn = picture.panels == 0 || plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
