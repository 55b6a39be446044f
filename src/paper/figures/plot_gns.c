/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gns: the error of rollouts over time for each way of training, one panel a scene; and how shapes deform without
   projection. */
#include "paper/figures/plot_parts.h"
#include "paper/systems/gns_study.h"

#include <math.h>
#include <string.h>

enum { SCENES = 3, PANELS = SCENES + 1, SHAPES = SCENES };

static const char *const scenes[SCENES] = {"single", "stack", "pyramid_settled"};

/* mm */
static const double height = 66, left = 13.5, right = 2, gap = 9.5, shape_gap = 6, bottom = 22, top = 6;

/* m: limits of what is shown. */
static const double least_shown = 1e-3, most_shown = 1e3;

typedef struct Figure {
    const GnsRow *rows;
    int count;
    double last; /* s */
} Figure;

static bool shows(const GnsRow *row, const char *scene, int variant) {
    return row->measure == GNS_ROLLOUT && strcmp(row->scene, scene) == 0 &&
           strcmp(row->variant, gns_variants[variant].name) == 0;
}

/* A quick study does not have all scenes. */
static bool has_rows(const Figure *figure, const char *scene) {
    for (int i = 0; i < figure->count; i++)
        if (shows(&figure->rows[i], scene, GNS_SHIPPED)) return true;
    return false;
}

static PlotAxis make_axis(const Figure *figure, bool shape, const char *label) {
    PlotRange range = plot_range();
    for (int i = 0; i < figure->count; i++) {
        const GnsRow *row = &figure->rows[i];
        if (row->measure != GNS_ROLLOUT || (shape && !shows(row, row->scene, GNS_NOT_RIGID))) continue;
        plot_range_include(&range, shape ? row->shape : row->error);
    }
    return plot_range_axis(range, least_shown, most_shown, false, label);
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[PANELS] = {"Single box", "Stack", "Settled pyramid", "Shape, rigid=off"};
    const Figure *figure = of;
    const double width = (FIGURE_PAGE_WIDTH - left - right - (PANELS - 1) * gap - shape_gap) / PANELS;
    const bool shape = panel == SCENES;
    double at = left + (shape ? shape_gap : 0); /* the shapes' own axis has a label */
    if (!shape && !has_rows(figure, scenes[panel])) return;
    for (int before = 0; before < panel; before++) at += has_rows(figure, scenes[before]) ? width + gap : 0;
    out->box = (PlotBox){at, bottom, width, height - bottom - top};
    out->title = titles[panel];
    out->x = plot_linear_axis(0, figure->last * 1.03, "Time after the launch (s)");
    out->y = make_axis(figure, shape,
                       shape        ? "Distance from a box (m)"
                       : panel == 0 ? "Distance from the run (m)"
                                    : "");
}

/* Variants, then the scenes of the last panel. */
static PlotLook look_of(const void *of, int series) {
    static const char *const names[GNS_VARIANTS + SHAPES] = {"M = 5",
                                                             "M = 2",
                                                             "M = 1",
                                                             "M = 5, without noise",
                                                             "M = 5, rigid=off",
                                                             "shape, single",
                                                             "shape, stack",
                                                             "shape, settled pyramid"};
    (void)of;
    return plot_look(series, names[series]);
}

static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const GnsRow *row = &((const Figure *)of)->rows[i];
    const bool shape = panel == SCENES;
    if (shape != (series >= GNS_VARIANTS)) return false;
    const char *scene = scenes[shape ? series - GNS_VARIANTS : panel];
    *out = (PlotPoint){row->seconds, shape ? row->shape : row->error, 0};
    return shows(row, scene, shape ? GNS_NOT_RIGID : series);
}

bool plot_gns(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &gns_table_layout, error)) return false;
    Figure figure = {table.rows, table.count, 0};
    for (int i = 0; i < table.count; i++)
        if (figure.rows[i].measure == GNS_ROLLOUT) figure.last = fmax(figure.last, figure.rows[i].seconds);
    const PlotSpec spec = {
        .of = &figure,
        .width = FIGURE_PAGE_WIDTH,
        .height = height,
        .panels = PANELS,
        .series = GNS_VARIANTS + SHAPES,
        .rows = figure.count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 4,
        .legend_left = 3,
        .legend_top = 6,
        .caption = "Graph network-based simulator: mean distance of the boxes from their places in the run of the "
                   "method that the network was taught by, over the time after the launch, by rounds of messages M, "
                   "without noise in training, and without projection back to rigid boxes (rigid=off). Right: distance "
                   "of the particles from the rigid box that fits them best, rigid=off. Held-out launches."};
    const bool drawn = !(figure.last > 0) || plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
