/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three panels over the launches, a line for each scene: share answered, time of a step, time saved. */
#include "paper/figures/plot_parts.h"
#include "paper/systems/hybrid_study.h"

#include <math.h>

enum { PANELS = 3, CHANGING = PAPER_SCENES, GUIDE = 2 * PAPER_SCENES, SERIES };

static const PlotGrid grid = {.width = FIGURE_PAGE_WIDTH,
                              .height = 62,
                              .left = 12,
                              .right = 3,
                              .bottom = 19,
                              .top = 6,
                              .columns = PANELS,
                              .rows = 1,
                              .gap = 13};

/* Ratios beyond these are drawn at the edge. */
static const double least_ratio = 1e-3, most_ratio = 1e3;

static const double standard_tolerance = 0.1; /* m/s */

typedef struct Learnings {
    const HybridRow *rows;
    int count;
    double most, change; /* launches; NAN: the family does not change */
} Learnings;

static double value_of(const HybridRow *row, int panel) {
    if (panel == 0) return 100 * row->share;
    if (panel == 1) return row->us_step / row->us_step_solve;
    return (row->saved_ms + row->learning_ms) / row->learning_ms;
}

static void find_range(Learnings *all) {
    all->most = 1;
    all->change = NAN;
    for (int i = 0; i < all->count; i++) {
        const HybridRow *row = &all->rows[i];
        all->most = fmax(all->most, row->launches);
        if (row->changes == 1 && row->turned == 0)
            all->change = fmax(all->change, row->launches); /* of a number and NAN, the number */
    }
    if (all->change >= all->most) all->change = NAN;
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[PANELS] = {"Answered", "Time", "Return of learning"};
    static const char *const labels[PANELS] = {"Impact steps answered (%)", "Step time / interior's",
                                               "Saved / spent on learning"};
    const Learnings *all = of;
    PlotRange range = {1, 1};
    for (int i = 0; i < all->count; i++) plot_range_include(&range, value_of(&all->rows[i], panel));
    out->box = plot_grid_box(&grid, panel);
    out->title = titles[panel];
    out->x = plot_linear_axis(0, all->most * 1.03, "Launches");
    out->y = panel == 0 ? plot_linear_axis(0, 100, labels[0])
                        : plot_range_axis(range, least_ratio, most_ratio, false, labels[panel]);
}

/* The scenes; thin: the same where the family changes. */
static PlotLook look_of(const void *of, int series) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    (void)of;
    if (series == GUIDE) return plot_look_dashed(NULL);
    return series < CHANGING ? plot_look(series, names[series]) : plot_look_thin(plot_look(series - CHANGING, NULL));
}

/* Of the guide: a ratio of 1, and the launch after which the family changes. */
static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Learnings *all = of;
    const HybridRow *row = &all->rows[i];
    if (series == GUIDE) {
        const double end = i == 0 ? -INFINITY : INFINITY;
        *out = panel == 0 ? (PlotPoint){all->change, end, 0} : (PlotPoint){end, 1, 0};
        return i < 2;
    }
    if (series >= CHANGING && panel > 0) return false;
    *out = (PlotPoint){row->launches, value_of(row, panel), 0};
    return row->scene == series % PAPER_SCENES && row->changes == (series >= CHANGING) &&
           fabs(row->tolerance - standard_tolerance) < 1e-6;
}

bool plot_hybrid(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &hybrid_layout, error)) return false;
    Learnings all = {.rows = table.rows, .count = table.count};
    find_range(&all);
    const PlotSpec spec = {
        .of = &all,
        .width = grid.width,
        .height = grid.height,
        .panels = PANELS,
        .series = SERIES,
        .rows = all.count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = PAPER_SCENES,
        .legend_left = grid.left,
        .legend_top = 4.5,
        .caption = "A memory of impacts that grows from launch to launch. Left: share of the steps with an impact that "
                   "it answers. Middle: time of such a step, answered or not, over that of interior:near=0.001, on "
                   "launches not learned. Right: time that answers have saved so far over the time that learning took "
                   "(dashed: it has paid). Thin: bombs turn and spin from the vertical line on."};
    const bool drawn = plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
