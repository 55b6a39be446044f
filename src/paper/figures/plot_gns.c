/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gns: the error of rollouts over time for each way of training, one panel a scene; and how shapes deform without
   projection. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/systems/gns_study.h"

#include <math.h>
#include <string.h>

enum { SCENES = 3, PANELS = SCENES + 1, SHAPES = SCENES };

static const char *const scenes[SCENES] = {"single", "stack", "pyramid_settled"};
static const char *const titles[PANELS] = {"Single box", "Stack", "Settled pyramid", "Shape, rigid=off"};

/* mm */
static const double height = 66, left = 13.5, right = 2, gap = 9.5, shape_gap = 6, bottom = 22, top = 6,
                    legend_left = 3, legend_top = 6;

/* m: limits of what is shown. */
static const double least_shown = 1e-3, most_shown = 1e3;

typedef struct Figure {
    GnuplotPage *page;
    const GnsRow *rows;
    int count;
    double last; /* s */
} Figure;

static bool shows(const GnsRow *row, const char *scene, int variant) {
    return row->measure == GNS_ROLLOUT && strcmp(row->scene, scene) == 0 &&
           strcmp(row->variant, gns_variants[variant].name) == 0;
}

static bool has_rows(const Figure *figure, const char *scene) {
    for (int i = 0; i < figure->count; i++)
        if (shows(&figure->rows[i], scene, GNS_SHIPPED)) return true;
    return false;
}

static void draw_line(const Figure *figure, const char *scene, int variant, bool shape, const GnuplotAxis *y,
                      const GnuplotLook *look) {
    gnuplot_series_begin(figure->page);
    for (int i = 0; i < figure->count; i++) {
        const GnsRow *row = &figure->rows[i];
        if (!shows(row, scene, variant)) continue;
        const double value = shape ? row->shape : row->error;
        gnuplot_point(figure->page, row->seconds, gnuplot_axis_clamp(figure->page, y, value));
    }
    gnuplot_series_end(figure->page, look);
}

static GnuplotAxis make_axis(const Figure *figure, bool shape) {
    GnuplotRange range = gnuplot_range();
    for (int i = 0; i < figure->count; i++)
        if (figure->rows[i].measure == GNS_ROLLOUT)
            gnuplot_range_include(
                &range,
                shape ? (shows(&figure->rows[i], figure->rows[i].scene, GNS_NOT_RIGID) ? figure->rows[i].shape : NAN)
                      : figure->rows[i].error);
    return gnuplot_axis(range, least_shown, most_shown, false);
}

/* Variants, then the scenes of the last panel. */
static void make_looks(GnuplotLook looks[GNS_VARIANTS + SHAPES]) {
    static const char *const names[GNS_VARIANTS] = {"M = 5", "M = 2", "M = 1", "M = 5, without noise",
                                                    "M = 5, rigid=off"};
    static const char *const shapes[SHAPES] = {"shape, single", "shape, stack", "shape, settled pyramid"};
    for (int v = 0; v < GNS_VARIANTS; v++) looks[v] = gnuplot_look(v, names[v]);
    for (int s = 0; s < SHAPES; s++) looks[GNS_VARIANTS + s] = gnuplot_look(GNS_VARIANTS + s, shapes[s]);
}

static void draw_panel(const Figure *figure, int panel, GnuplotBox box, const GnuplotLook *looks) {
    const bool shape = panel == SCENES;
    GnuplotPage *page = figure->page;
    gnuplot_panel_begin(page, box, titles[panel]);
    gnuplot_linear_axis(page, 'x', 0, figure->last * 1.03, NULL, "Time after the launch (s)");
    const GnuplotAxis y = make_axis(figure, shape);
    gnuplot_log_axis(page, 'y', &y, shape ? "Distance from a box (m)" : panel == 0 ? "Distance from the run (m)" : "");
    if (shape)
        for (int s = 0; s < SHAPES; s++)
            draw_line(figure, scenes[s], GNS_NOT_RIGID, true, &y, &looks[GNS_VARIANTS + s]);
    else
        for (int v = GNS_VARIANTS - 1; v >= 0; v--) draw_line(figure, scenes[panel], v, false, &y, &looks[v]);
    gnuplot_panel_end(page);
}

static void draw(const Figure *figure) {
    GnuplotPage *page = figure->page;
    GnuplotLook looks[GNS_VARIANTS + SHAPES];
    make_looks(looks);
    gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, height);
    const double width = (page->width - left - right - (PANELS - 1) * gap - shape_gap) / PANELS;
    double at = left;
    for (int panel = 0; panel < PANELS; panel++) {
        if (panel < SCENES && !has_rows(figure, scenes[panel])) continue; /* in a quick study */
        if (panel == SCENES) at += shape_gap;                             /* its own axis has a label */
        draw_panel(figure, panel, (GnuplotBox){at, bottom, width, height - bottom - top}, looks);
        at += width + gap;
    }
    gnuplot_legend(page, looks, GNS_VARIANTS + SHAPES, 4, legend_left, legend_top);
    fprintf(
        page->caption,
        "Graph network-based simulator: mean distance of the boxes from their places in the run of the method that "
        "the network was taught by, over the time after the launch, by rounds of messages M, without noise in "
        "training, and without projection back to rigid boxes (rigid=off). Right: distance of the particles from the "
        "rigid box that fits them best, rigid=off. Held-out launches.");
    gnuplot_page_end(page);
}

bool plot_gns(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &gns_table_layout, error)) return false;
    Figure figure = {page, table.rows, table.count, 0};
    for (int i = 0; i < table.count; i++)
        if (figure.rows[i].measure == GNS_ROLLOUT) figure.last = fmax(figure.last, figure.rows[i].seconds);
    if (figure.last > 0) draw(&figure);
    csv_table_free(&table);
    return true;
}
