/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of the systems that the paper cites. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/sketch.h"
#include "learning/subspace_training.h"
#include "methods/sain_view.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Two panels: the error of sain and its ablations over the number of launches of the stack, on the stack and on the
   settled pyramid. */

enum { SAIN_ENGINE = SAIN_FORMS, SAIN_CONSTANT, SAIN_SERIES };

static PlotLook sain_look(const void *of, int series) {
    static const char *const names[SAIN_FORMS] = {"sain", "engine=off: network alone", "engine=shuffled"};
    (void)of;
    if (series == SAIN_ENGINE) return plot_look_dashed("engine alone, 10 sweeps");
    if (series == SAIN_CONSTANT) return plot_look_thin(plot_look(SAIN_FORMS, "mean correction"));
    return plot_look(series, names[series]);
}

/* Row i: 2^i launches. */
static bool sain_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    SainNumber *const number = series == SAIN_ENGINE     ? sain_engine_error
                               : series == SAIN_CONSTANT ? sain_constant_error
                                                         : sain_error;
    const SainForm form = series < SAIN_FORMS ? (SainForm)series : SAIN_WITH_ENGINE;
    *out = (PlotPoint){1 << i, sain_median(of, (SainScene)panel, form, 1 << i, number), 0};
    return 1 << i <= SAIN_MAX_LAUNCHES;
}

static void sain_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[SAIN_SCENES] = {"stack, held-out launches", "settled pyramid, never trained on"};
    PlotPoint point;
    double most = 1e-6;
    for (int series = 0; series < SAIN_SERIES; series++)
        for (int i = 0; sain_point(of, panel, series, i, &point); i++)
            most = fmax(most, point.y); /* of a number and NAN, the number */
    out->title = titles[panel];
    out->x = plot_linear_axis(0.8, 1.25 * sain_most_launches(of), "Launches of the stack");
    out->x.scale = PLOT_DOUBLING;
    out->y = plot_linear_axis(0, most * 1.08, panel == 0 ? "RMS velocity error (m/s)" : "");
}

bool plot_sain(const CsvTable *table, PlotPage *page, Error *error) {
    const PlotSpec spec = {
        .of = table,
        .grid = {FIGURE_PAGE_WIDTH, 68, 14, 2, 22, 7, SAIN_SCENES, 1, .gap = 14},
        .panels = SAIN_SCENES,
        .series = SAIN_SERIES,
        .rows = 31,
        .panel = sain_panel,
        .look = sain_look,
        .point = sain_point,
        .legend_columns = 3,
        .legend_left = 6,
        .legend_top = 8,
        .caption =
            "Velocity error at the impacts of held-out launches, over the number of launches of the stack that "
            "sain and its ablations were trained on: left on the stack, right on the settled pyramid, which none "
            "of them has seen. Medians over seeds."};
    return plot_draw(page, &spec, table->csv.path, error);
}

/* A panel for each scene: distance from the offline engine's runs over the time of a step. Subspace with its floor and
   its linear term, and the engines that it replaces. */

enum { COLUMNS = 2 };

/* m: below this a distance is rounding; the runs were recorded by interior, whose own distance is 0. */
static const double least_distance = 1e-4;

typedef enum Series { NETWORK, LINEAR, FLOOR, ENGINE, INTERIOR, CONVERGED, LOOKS } Series;

static const char *const engines[LOOKS] = {
    [ENGINE] = "engine", [INTERIOR] = SUBSPACE_OFFLINE, [CONVERGED] = SUBSPACE_STUDY_OFFLINE};

typedef struct Distances {
    const SubspaceStudyRow *rows;
    int count, panels;
    int scenes[PAPER_SCENES]; /* [panels] that have rows */
} Distances;

static PlotLook subspace_look(const void *of, int series) {
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

static bool subspace_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Distances *picture = of;
    const SubspaceStudyRow *row = &picture->rows[i];
    *out = (PlotPoint){row->us_step, distance_of(row, series), 0};
    return row->scene == picture->scenes[panel];
}

static void subspace_panel(const void *of, int panel, PlotPanel *out) {
    const Distances *picture = of;
    PlotRange time = plot_range(), distance = plot_range();
    for (int i = 0; i < picture->count; i++) {
        plot_range_include(&time, picture->rows[i].us_step);
        for (int series = 0; series < LOOKS; series++)
            plot_range_include(&distance, distance_of(&picture->rows[i], series));
    }
    out->title = paper_scene_titles[picture->scenes[panel]];
    out->x = plot_range_axis(time, 1e-3, 1e6, false, "Time of a step (µs)");
    out->y = plot_range_axis(distance, least_distance, 1e3, false, panel % COLUMNS == 0 ? "Distance (m)" : NULL);
}

/* The scenes with rows, in the order of the paper. */
static void find_scenes(Distances *picture) {
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        bool found = false;
        for (int i = 0; i < picture->count; i++) found |= picture->rows[i].scene == scene;
        if (found) picture->scenes[picture->panels++] = scene;
    }
}

bool plot_subspace(const CsvTable *table, PlotPage *page, Error *error) {
    const double panel_height = 38, row_gap = 14, bottom = 23.5, top = 6; /* mm */
    Distances picture = {.rows = table->rows, .count = table->count};
    find_scenes(&picture);
    const int rows = (picture.panels + COLUMNS - 1) / COLUMNS;
    const double height = bottom + rows * (panel_height + row_gap) - row_gap + top;
    const PlotSpec spec = {
        .of = &picture,
        .grid = {FIGURE_PAGE_WIDTH, height, 13, 3, bottom, top, COLUMNS, rows, 4, row_gap},
        .panels = picture.panels,
        .series = LOOKS,
        .rows = picture.count,
        .panel = subspace_panel,
        .look = subspace_look,
        .point = subspace_point,
        .legend_columns = 2,
        .legend_left = 13,
        .legend_top = 10,
        .caption =
            "subspace on held-out launches: distance of positions from the offline engine's runs (RMS over "
            "bodies and frames) over the time of a step. With it: its linear term alone, the floor (the recorded "
            "poses reduced to the components), and engines, whose time is the whole step. 0.0001 m: at most."};
    return picture.panels == 0 || plot_draw(page, &spec, table->csv.path, error);
}

/* Three panels over the launches, a line for each scene: share answered, time of a step, time saved. */

enum { HYBRID_PANELS = 3, CHANGING = PAPER_SCENES, GUIDE = 2 * PAPER_SCENES, HYBRID_SERIES };

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

static void hybrid_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[HYBRID_PANELS] = {"Answered", "Time", "Return of learning"};
    static const char *const labels[HYBRID_PANELS] = {"Impact steps answered (%)", "Step time / interior's",
                                                      "Saved / spent on learning"};
    const Learnings *all = of;
    PlotRange range = {1, 1};
    for (int i = 0; i < all->count; i++) plot_range_include(&range, value_of(&all->rows[i], panel));
    out->title = titles[panel];
    out->x = plot_linear_axis(0, all->most * 1.03, "Launches");
    out->y = panel == 0 ? plot_linear_axis(0, 100, labels[0])
                        : plot_range_axis(range, least_ratio, most_ratio, false, labels[panel]);
}

/* The scenes; thin: the same where the family changes. */
static PlotLook hybrid_look(const void *of, int series) {
    (void)of;
    if (series == GUIDE) return plot_look_dashed(NULL);
    return series < CHANGING ? plot_look(series, paper_scene_titles[series])
                             : plot_look_thin(plot_look(series - CHANGING, NULL));
}

/* Of the guide: a ratio of 1, and the launch after which the family changes. */
static bool hybrid_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Learnings *all = of;
    const HybridRow *row = &all->rows[i];
    if (series == GUIDE) return panel == 0 ? plot_upright(out, i, all->change) : plot_level(out, i, 1);
    if (series >= CHANGING && panel > 0) return false;
    *out = (PlotPoint){row->launches, value_of(row, panel), 0};
    return row->scene == series % PAPER_SCENES && row->changes == (series >= CHANGING) &&
           fabs(row->tolerance - standard_tolerance) < 1e-6;
}

bool plot_hybrid(const CsvTable *table, PlotPage *page, Error *error) {
    Learnings all = {.rows = table->rows, .count = table->count};
    find_range(&all);
    const PlotSpec spec = {
        .of = &all,
        .grid = {FIGURE_PAGE_WIDTH, 62, 12, 3, 19, 6, HYBRID_PANELS, 1, .gap = 13},
        .panels = HYBRID_PANELS,
        .series = HYBRID_SERIES,
        .rows = all.count,
        .panel = hybrid_panel,
        .look = hybrid_look,
        .point = hybrid_point,
        .legend_columns = PAPER_SCENES,
        .legend_left = 12,
        .legend_top = 4.5,
        .caption = "A memory of impacts that grows from launch to launch. Left: share of the steps with an impact that "
                   "it answers. Middle: time of such a step, answered or not, over that of interior:near=0.001, on "
                   "launches not learned. Right: time that answers have saved so far over the time that learning took "
                   "(dashed: it has paid). Thin: bombs turn and spin from the vertical line on."};
    return plot_draw(page, &spec, table->csv.path, error);
}

/* gns: the error of rollouts over time for each way of training, one panel a scene; and how shapes deform without
   projection. */

enum { SCENES = 3, GNS_PANELS = SCENES + 1, SHAPES = SCENES };

static const char *const scenes[SCENES] = {"single", "stack", "pyramid_settled"};

static const PlotGrid gns_grid = {FIGURE_PAGE_WIDTH, 66, 13.5, 2, 22, 6, GNS_PANELS, 1, .gap = 9.5};
static const double shape_gap = 6; /* mm: the shapes' own axis has a label */

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

static void gns_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[GNS_PANELS] = {"Single box", "Stack", "Settled pyramid", "Shape, rigid=off"};
    assert(panel < GNS_PANELS);
    const Figure *figure = of;
    const bool shape = panel == SCENES;
    const double width = out->box.width - shape_gap / GNS_PANELS;
    out->box.left = gns_grid.left + (shape ? shape_gap : 0);
    out->box.width = !shape && !has_rows(figure, scenes[panel]) ? 0 : width;
    for (int i = 0; i < panel; i++) out->box.left += has_rows(figure, scenes[i]) ? width + gns_grid.gap : 0;
    out->title = titles[panel];
    out->x = plot_linear_axis(0, figure->last * 1.03, "Time after the launch (s)");
    out->y = make_axis(figure, shape,
                       shape        ? "Distance from a box (m)"
                       : panel == 0 ? "Distance from the run (m)"
                                    : "");
}

/* Variants, then the scenes of the last panel. */
static PlotLook gns_look(const void *of, int series) {
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

static bool gns_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const GnsRow *row = &((const Figure *)of)->rows[i];
    const bool shape = panel == SCENES;
    if (shape != (series >= GNS_VARIANTS)) return false;
    const char *scene = scenes[shape ? series - GNS_VARIANTS : panel];
    *out = (PlotPoint){row->seconds, shape ? row->shape : row->error, 0};
    return shows(row, scene, shape ? GNS_NOT_RIGID : series);
}

bool plot_gns(const CsvTable *table, PlotPage *page, Error *error) {
    Figure figure = {table->rows, table->count, 0};
    for (int i = 0; i < table->count; i++)
        if (figure.rows[i].measure == GNS_ROLLOUT) figure.last = fmax(figure.last, figure.rows[i].seconds);
    const PlotSpec spec = {
        .of = &figure,
        .grid = gns_grid,
        .panels = GNS_PANELS,
        .series = GNS_VARIANTS + SHAPES,
        .rows = figure.count,
        .panel = gns_panel,
        .look = gns_look,
        .point = gns_point,
        .legend_columns = 4,
        .legend_left = 3,
        .legend_top = 6,
        .caption = "Graph network-based simulator: mean distance of the boxes from their places in the run of the "
                   "method that the network was taught by, over the time after the launch, by rounds of messages M, "
                   "without noise in training, and without projection back to rigid boxes (rigid=off). Right: distance "
                   "of the particles from the rigid box that fits them best, rigid=off. Held-out launches."};
    return !(figure.last > 0) || plot_draw(page, &spec, table->csv.path, error);
}
