/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/plot_page.h"

#include "common/file.h"
#include "sketch/sketch_files.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void plot_page_free(PlotPage *page) { sketch_free(&page->sketch); }

bool plot_page_write(PlotPage *page, const char *folder, const char *prefix, const char *name, Error *error) {
    char stem[PATH_MAX], caption[PATH_MAX + 4];
    if (page->sketch.width <= 0) return true;
    if (!file_path(stem, sizeof stem, error, "%s/%s%s", folder, prefix, name)) return false;
    snprintf(caption, sizeof caption, "%s.txt", stem);
    snprintf(page->sketch.title, sizeof page->sketch.title, "%s", name);
    return sketch_draw(&page->sketch, stem, SKETCH_SVG, error) &&
           file_write(caption, page->caption, strlen(page->caption), error);
}

/* What plot_draw() draws with. */
typedef struct Plotter {
    const PlotSpec *spec;
    Sketch *sketch;
    PlotPoint *points; /* [rows] of the open series */
    Point *places;     /* [2 * rows] */
    bool beyond;       /* a value was clamped to its axis */
    bool used[PLOT_SERIES];
} Plotter;

/* The points of a series, clamped to the axes. */
static int gather(Plotter *plotter, const PlotPanel *panel, int index, int series) {
    int count = 0;
    for (int row = 0; row < plotter->spec->rows; row++) {
        PlotPoint point = {0};
        if (!plotter->spec->point(plotter->spec->of, index, series, row, &point)) continue;
        point.x = plot_axis_clamp(&panel->x, point.x, &plotter->beyond);
        point.y = plot_axis_clamp(&panel->y, point.y, &plotter->beyond);
        if (!isnan(point.x + point.y)) plotter->points[count++] = point;
    }
    if (count > 0) plotter->used[series] = true;
    return count;
}

static int compare(double a, double b) { return (a > b) - (a < b); }

static int by_group(const void *first, const void *second) {
    const PlotPoint *a = first, *b = second;
    int order = compare(a->group, b->group);
    if (order == 0) order = compare(a->x, b->x);
    return order != 0 ? order : compare(a->y, b->y);
}

static int by_place(const void *first, const void *second) {
    const PlotPoint *a = first, *b = second;
    const int order = compare(a->x, b->x);
    return order != 0 ? order : compare(a->y, b->y);
}

/* Replaces the points by their medians at each x. */
static int to_medians(PlotPoint *points, int count) {
    int medians = 0;
    qsort(points, (size_t)count, sizeof *points, by_place);
    for (int i = 0, end; i < count; i = end) {
        for (end = i; end < count && points[end].x == points[i].x;) end++;
        const double y = (points[(i + end - 1) / 2].y + points[(i + end) / 2].y) / 2;
        points[medians++] = (PlotPoint){points[i].x, y, 0};
    }
    return medians;
}

static void draw_points(Plotter *plotter, const PlotPanel *panel, int count, const PlotLook *look) {
    int places = 0;
    for (int i = 0; i < count; i++) {
        const PlotPoint *point = &plotter->points[i];
        if (i > 0 && point->group != point[-1].group) plotter->places[places++] = (Point){NAN, NAN};
        plotter->places[places++] = plot_place(panel, point->x, point->y);
    }
    plot_line(plotter->sketch, plotter->places, places, look);
}

static void draw_stems(Plotter *plotter, const PlotPanel *panel, int count, const PlotLook *look) {
    const Pen pen = pen_line(look->style.colour, look->line, NULL);
    for (int i = 0; i < count; i++) {
        const PlotPoint *point = &plotter->points[i];
        sketch_line(plotter->sketch, plot_place(panel, point->x, 0), plot_place(panel, point->x, point->y), &pen);
    }
}

static void draw_band(Plotter *plotter, const PlotPanel *panel, const PlotLook *look) {
    const PlotPoint *corners = plotter->points;
    sketch_rectangle(plotter->sketch, plot_place(panel, corners[0].x, corners[0].y),
                     plot_place(panel, corners[1].x, corners[1].y), &(Pen){look->style.colour, 1, NO_COLOUR, 0, NULL});
}

/* From bottom to top. */
typedef enum Pass { PASS_SEEDS, PASS_BELOW, PASS_ABOVE, PASSES } Pass;

static void draw_series(Plotter *plotter, const PlotPanel *panel, int index, int series, Pass pass) {
    PlotLook look = plotter->spec->look(plotter->spec->of, series);
    int count = gather(plotter, panel, index, series);
    if (count == 0 || (pass == PASS_SEEDS ? !look.seeds : look.above != (pass == PASS_ABOVE))) return;
    if (pass == PASS_SEEDS) {
        qsort(plotter->points, (size_t)count, sizeof *plotter->points, by_group);
        look = plot_look_thin(look);
    } else if (look.seeds || look.medians)
        count = to_medians(plotter->points, count);
    if (look.band) {
        if (count > 1) draw_band(plotter, panel, &look);
        return;
    }
    if (look.stems) {
        draw_stems(plotter, panel, count, &look);
        look.line = 0;
    }
    draw_points(plotter, panel, count, &look);
}

static void draw_panel(Plotter *plotter, int index) {
    PlotPanel panel = {0};
    plotter->spec->panel(plotter->spec->of, index, &panel);
    if (panel.box.width <= 0) return;
    plot_panel_place(&panel);
    for (int pass = 0; pass < PASSES; pass++)
        for (int series = plotter->spec->series - 1; series >= 0; series--)
            draw_series(plotter, &panel, index, series, (Pass)pass);
    plot_panel_draw(plotter->sketch, &panel);
}

static void draw_legend(const Plotter *plotter) {
    const PlotSpec *spec = plotter->spec;
    PlotLook looks[PLOT_SERIES];
    int count = 0;
    for (int series = 0; series < spec->series; series++)
        if (plotter->used[series]) looks[count++] = spec->look(spec->of, series);
    plot_legend(plotter->sketch, looks, count, spec->legend_columns, spec->legend_left, spec->legend_top);
}

bool plot_draw(PlotPage *page, const PlotSpec *spec, const char *what, Error *error) {
    Plotter plotter = {.spec = spec, .sketch = &page->sketch};
    plotter.points = malloc((size_t)spec->rows * sizeof *plotter.points + 1);
    plotter.places = malloc(2 * (size_t)spec->rows * sizeof *plotter.places + 1);
    const bool room = plotter.points != NULL && plotter.places != NULL;
    sketch_begin(&page->sketch, spec->width, spec->height);
    for (int panel = 0; room && panel < spec->panels; panel++) draw_panel(&plotter, panel);
    if (room) draw_legend(&plotter);
    snprintf(page->caption, sizeof page->caption, "%s%s\n", spec->caption,
             plotter.beyond ? " Values beyond an axis are drawn at its edge." : "");
    free(plotter.points);
    free(plotter.places);
    return (room && !page->sketch.failed) || error_memory(error, what);
}
