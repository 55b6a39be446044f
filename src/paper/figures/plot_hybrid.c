/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three panels over the launches, a line for each scene: share answered, time of a step, time saved. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/systems/hybrid_study.h"

#include <math.h>

enum { PANELS = 3 };

/* mm */
static const double height = 62, left = 12, gap = 13, right = 3, bottom = 19, top = 6, legend_top = 4.5;

/* Ratios beyond these are drawn at the edge. */
static const double least_ratio = 1e-3, most_ratio = 1e3;

static const double standard_tolerance = 0.1; /* m/s */

typedef struct Learnings {
    GnuplotPage *page;
    const HybridRow *rows;
    int count;
    double most, change; /* launches; NAN: the family does not change */
} Learnings;

static const char *const titles[PANELS] = {"Answered", "Time", "Return of learning"};
static const char *const labels[PANELS] = {"Impact steps answered (%)", "Step time / interior's",
                                           "Saved / spent on learning"};

static double value_of(const HybridRow *row, int panel) {
    if (panel == 0) return 100 * row->share;
    if (panel == 1) return row->us_step / row->us_step_solve;
    return (row->saved_ms + row->learning_ms) / row->learning_ms;
}

static bool is_shown(const HybridRow *row, int scene, int changes) {
    return row->scene == scene && row->changes == changes && fabs(row->tolerance - standard_tolerance) < 1e-6;
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

static GnuplotAxis ratio_axis(const Learnings *all, int panel) {
    GnuplotRange range = {1, 1};
    for (int i = 0; i < all->count; i++) gnuplot_range_include(&range, value_of(&all->rows[i], panel));
    return gnuplot_axis(range, least_ratio, most_ratio, false);
}

/* A ratio of 1, and the launch after which the family changes. */
static void draw_guides(const Learnings *all, int panel, double low, double high) {
    const GnuplotLook dashed = gnuplot_look_dashed("");
    gnuplot_series_begin(all->page);
    if (panel > 0) gnuplot_segment(all->page, 0, 1, all->most * 1.03, 1);
    if (panel == 0 && !isnan(all->change)) gnuplot_segment(all->page, all->change, low, all->change, high);
    gnuplot_series_end(all->page, &dashed);
}

static GnuplotLook look_of(int scene) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    return gnuplot_look(scene, names[scene]);
}

/* Thin where the family changes. */
static void draw_line(const Learnings *all, int panel, const GnuplotAxis *axis, int scene, int changes) {
    GnuplotPage *page = all->page;
    const GnuplotLook look = changes ? gnuplot_look_thin(look_of(scene)) : look_of(scene);
    gnuplot_series_begin(page);
    for (int i = 0; i < all->count; i++) {
        const double value = value_of(&all->rows[i], panel);
        if (!is_shown(&all->rows[i], scene, changes) || isnan(value)) continue;
        gnuplot_point(page, all->rows[i].launches, panel == 0 ? value : gnuplot_axis_clamp(page, axis, value));
    }
    gnuplot_series_end(page, &look);
}

static void draw_panel(const Learnings *all, int panel) {
    GnuplotPage *page = all->page;
    const double width = (page->width - left - right - (PANELS - 1) * gap) / PANELS;
    const GnuplotAxis axis = ratio_axis(all, panel > 0 ? panel : 1);
    gnuplot_panel_begin(page, (GnuplotBox){left + panel * (width + gap), bottom, width, height - bottom - top},
                        titles[panel]);
    gnuplot_linear_axis(page, 'x', 0, all->most * 1.03, NULL, "Launches");
    if (panel == 0)
        gnuplot_linear_axis(page, 'y', 0, 100, NULL, labels[panel]);
    else
        gnuplot_log_axis(page, 'y', &axis, labels[panel]);
    draw_guides(all, panel, panel == 0 ? 0 : axis.log.low, panel == 0 ? 100 : axis.log.high);
    for (int changes = panel == 0; changes >= 0; changes--)
        for (int scene = 0; scene < PAPER_SCENES; scene++) draw_line(all, panel, &axis, scene, changes);
    gnuplot_panel_end(page);
}

bool plot_hybrid(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &hybrid_layout, error)) return false;
    Learnings all = {.page = page, .rows = table.rows, .count = table.count};
    GnuplotLook looks[PAPER_SCENES];
    find_range(&all);
    gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, height);
    for (int panel = 0; panel < PANELS; panel++) draw_panel(&all, panel);
    for (int scene = 0; scene < PAPER_SCENES; scene++) looks[scene] = look_of(scene);
    gnuplot_legend(page, looks, PAPER_SCENES, PAPER_SCENES, left, legend_top);
    fprintf(page->caption,
            "A memory of impacts that grows from launch to launch. Left: share of the steps with an impact that it "
            "answers. "
            "Middle: time of such a step, answered or not, over that of interior:near=0.001, on launches not learned. "
            "Right: time that answers have saved so far over the time that learning took (dashed: it has paid). "
            "Thin: bombs turn and spin from the vertical line on.");
    gnuplot_page_end(page);
    csv_table_free(&table);
    return true;
}
