/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels: the error of sain and its ablations over the number of launches of the stack, on the stack and on the
   settled pyramid. */
#include "paper/figures/plot_parts.h"
#include "paper/systems/sain_study.h"

#include <math.h>

enum { ENGINE = RELATION_FORMS, CONSTANT, SERIES };

static const PlotGrid grid = {.width = FIGURE_PAGE_WIDTH,
                              .height = 68,
                              .left = 14,
                              .right = 2,
                              .bottom = 22,
                              .top = 7,
                              .columns = SAIN_SCENES,
                              .rows = 1,
                              .gap = 14};

static PlotLook look_of(const void *of, int series) {
    static const char *const names[RELATION_FORMS] = {"sain", "engine=off: network alone", "engine=shuffled"};
    (void)of;
    if (series == ENGINE) return plot_look_dashed("engine alone, 10 sweeps");
    if (series == CONSTANT) return plot_look_thin(plot_look(RELATION_FORMS, "mean correction"));
    return plot_look(series, names[series]);
}

/* Row i: 2^i launches. */
static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    SainNumber *const number = series == ENGINE     ? sain_engine_error
                               : series == CONSTANT ? sain_constant_error
                                                    : sain_error;
    const RelationForm form = series < RELATION_FORMS ? (RelationForm)series : RELATION_ENGINE;
    *out = (PlotPoint){1 << i, sain_median(of, (SainScene)panel, form, 1 << i, number), 0};
    return 1 << i <= SAIN_MAX_LAUNCHES;
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[SAIN_SCENES] = {"stack, held-out launches", "settled pyramid, never trained on"};
    PlotPoint point;
    double most = 1e-6;
    for (int series = 0; series < SERIES; series++)
        for (int i = 0; point_of(of, panel, series, i, &point); i++)
            most = fmax(most, point.y); /* of a number and NAN, the number */
    out->box = plot_grid_box(&grid, panel);
    out->title = titles[panel];
    out->x = plot_linear_axis(0.8, 1.25 * sain_most_launches(of), "Launches of the stack");
    out->x.scale = PLOT_DOUBLING;
    out->y = plot_linear_axis(0, most * 1.08, panel == 0 ? "RMS velocity error (m/s)" : "");
}

bool plot_sain(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &sain_layout, error)) return false;
    const PlotSpec spec = {
        .of = &table,
        .width = grid.width,
        .height = grid.height,
        .panels = SAIN_SCENES,
        .series = SERIES,
        .rows = 31,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 3,
        .legend_left = 6,
        .legend_top = 8,
        .caption =
            "Velocity error at the impacts of held-out launches, over the number of launches of the stack that "
            "sain and its ablations were trained on: left on the stack, right on the settled pyramid, which none "
            "of them has seen. Medians over seeds."};
    const bool drawn = plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
