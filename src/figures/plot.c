/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plots: panels with axes, series and legends; plot_draw() for those that differ in their data only. */
#include "base/base.h"
#include "base/file.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tick = 1, minor_tick = 0.55, number_gap = 1; /* mm */
static const double frame_width = 0.8, label_points = 8;

/* em: the middles of numbers and label below a panel, from where the ticks end. */
static const double number_drop = 0.75, label_drop = 2.05;

PlotBox plot_grid_box(const PlotGrid *grid, int place) {
    const double width = (grid->width - grid->left - grid->right - (grid->columns - 1) * grid->gap) / grid->columns;
    const double height = (grid->height - grid->bottom - grid->top - (grid->rows - 1) * grid->row_gap) / grid->rows;
    const int column = place % grid->columns, row = place / grid->columns;
    return (PlotBox){grid->left + column * (width + grid->gap),
                     grid->bottom + (grid->rows - 1 - row) * (height + grid->row_gap), width, height};
}

void plot_panel_place(PlotPanel *panel) {
    panel->x.from = panel->box.left, panel->x.to = panel->box.left + panel->box.width;
    panel->y.from = panel->box.bottom, panel->y.to = panel->box.bottom + panel->box.height;
}

Point plot_place(const PlotPanel *panel, double x, double y) {
    return (Point){plot_axis_place(&panel->x, x), plot_axis_place(&panel->y, y)};
}

static double label_size(const PlotPanel *panel) { return panel->points > 0 ? panel->points : label_points; }

static double number_size(const PlotPanel *panel) { return label_size(panel) * 7.5 / 8; }

double plot_left_margin(double points) {
    return tick + number_gap + sketch_power_width(points * 7.5 / 8, 1, -1) + 1.9 * points * MM_PER_POINT;
}

double plot_bottom_margin(double points) { return tick + (label_drop + 0.7) * points * MM_PER_POINT; }

static void draw_number(Sketch *sketch, const PlotTick *number, Point at, const TextStyle *style) {
    if (number->digit > 0)
        sketch_power_of_ten(sketch, at, style, number->digit, number->power);
    else if (number->text[0] != '\0') {
        const int first = (int)strcspn(number->text, "\n");
        sketch_text(sketch, at, style, "%.*s", first, number->text);
        at.y -= 1.15 * style->points * MM_PER_POINT;
        if (number->text[first] != '\0') sketch_text(sketch, at, style, "%s", number->text + first + 1);
    }
}

static void draw_x_axis(Sketch *sketch, const PlotPanel *panel, const PlotTicks *ticks) {
    const double em = label_size(panel) * MM_PER_POINT, bottom = panel->box.bottom, end = bottom - tick;
    const Pen pen = pen_line(INK, frame_width, NULL);
    const TextStyle numbers = {number_size(panel), TEXT_CENTER, INK, 0, false};
    for (int i = 0; i < ticks->count; i++) {
        const double x = plot_axis_place(&panel->x, ticks->items[i].value);
        const double length = ticks->items[i].minor ? minor_tick : tick;
        sketch_line(sketch, (Point){x, bottom}, (Point){x, bottom + (panel->x.outside ? -length : length)}, &pen);
        if (panel->x.label != NULL) draw_number(sketch, &ticks->items[i], (Point){x, end - number_drop * em}, &numbers);
    }
    if (panel->x.label != NULL)
        plot_text(sketch, (Point){panel->box.left + panel->box.width / 2, end - label_drop * em}, TEXT_CENTER,
                  label_size(panel), panel->x.label);
}

static void draw_y_axis(Sketch *sketch, const PlotPanel *panel, const PlotTicks *ticks) {
    const double em = label_size(panel) * MM_PER_POINT, left = panel->box.left;
    const double end = left - (panel->y.outside ? tick : 0) - number_gap;
    const Pen pen = pen_line(INK, frame_width, NULL), guide = pen_line(GRID_STRONG, 0.9, NULL);
    const TextStyle numbers = {number_size(panel), TEXT_RIGHT, INK, 0, false};
    double widest = 0;
    for (int i = 0; i < ticks->count; i++) {
        const PlotTick *number = &ticks->items[i];
        const double y = plot_axis_place(&panel->y, number->value), length = number->minor ? minor_tick : tick;
        if (panel->guides && !number->minor)
            sketch_line(sketch, (Point){left, y}, (Point){left + panel->box.width, y}, &guide);
        sketch_line(sketch, (Point){left, y}, (Point){left + (panel->y.outside ? -length : length), y}, &pen);
        if (panel->y.label != NULL) draw_number(sketch, number, (Point){end, y}, &numbers);
        widest = fmax(widest, plot_tick_width(number, numbers.points));
    }
    if (panel->y.label != NULL && panel->y.label[0] != '\0')
        sketch_text(sketch, (Point){end - widest - 0.95 * em, panel->box.bottom + panel->box.height / 2},
                    &(TextStyle){label_size(panel), TEXT_CENTER, INK, 90, false}, "%s", panel->y.label);
}

static const PlotTicks *ticks_of(const PlotPanel *panel, const PlotAxis *axis, PlotTicks *room) {
    if (axis->ticks != NULL) return axis->ticks;
    plot_ticks_choose(room, axis, number_size(panel), axis == &panel->x);
    return room;
}

void plot_panel_draw(Sketch *sketch, const PlotPanel *panel) {
    PlotTicks room;
    const PlotBox *box = &panel->box;
    const Pen pen = pen_line(INK, frame_width, NULL);
    draw_y_axis(sketch, panel, ticks_of(panel, &panel->y, &room));
    draw_x_axis(sketch, panel, ticks_of(panel, &panel->x, &room));
    sketch_rectangle(sketch, (Point){box->left, box->bottom},
                     (Point){box->left + box->width, box->bottom + box->height}, &pen);
    if (panel->title == NULL) return;
    double above = 2.5;
    for (const char *c = panel->title; *c != '\0'; c++) above += *c == '\n' ? line_height(label_size(panel)) : 0;
    plot_text(sketch, (Point){box->left, box->bottom + box->height + above}, TEXT_LEFT, label_size(panel),
              panel->title);
}

PlotLook plot_look(int i, const char *name) {
    return (PlotLook){.name = name, .style = plot_style(i), .line = 1.6, .marks = true};
}

PlotLook plot_look_marks(int i, const char *name) {
    return (PlotLook){.name = name, .style = plot_style(i), .marks = true};
}

PlotLook plot_look_dashed(const char *name) {
    return (PlotLook){.name = name, .style = {.colour = PLOT_GREY, .ink = PLOT_GREY, .dashes = "(3,1.8)"}, .line = 2};
}

PlotLook plot_look_guide(void) { return (PlotLook){.style = {.colour = 0xC8C8C8, .ink = 0xC8C8C8}, .line = 0.6}; }

/* A line through points of the page, and marks on them; a point that is NaN interrupts the line. */
static void draw_line(Sketch *sketch, const Point *points, int count, const PlotLook *look) {
    const Pen pen = pen_line(look->style.colour, look->line, look->style.dashes);
    for (int i = 0, end; i < count; i = end + 1) {
        for (end = i; end < count && !isnan(points[end].x + points[end].y);) end++;
        if (look->line > 0) sketch_path(sketch, points + i, end - i, &pen);
    }
    for (int i = 0, end; look->marks && i < count; i = end + 1) {
        for (end = i; end < count && !isnan(points[end].x + points[end].y);) end++;
        plot_marks(sketch, points + i, end - i, &look->style);
    }
}

void plot_text(Sketch *sketch, Point at, TextAlign align, double points, const char *text) {
    sketch_lines(sketch, at, &(TextStyle){points, align, INK, 0, false}, text);
}

static void draw_sample(Sketch *sketch, const PlotLook *look, double left, double y) {
    const Point middle = {left + LEGEND_SAMPLE / 2, y};
    const Point ends[] = {{left, y}, {left + LEGEND_SAMPLE, y}};
    const double half = 1.2; /* mm, of a band */
    PlotLook line = *look;
    line.marks = false;
    if (look->stems) line.style.dashes = NULL;
    if (look->band)
        sketch_rectangle(sketch, (Point){left, y - half}, (Point){left + LEGEND_SAMPLE, y + half},
                         &(Pen){look->style.colour, 1, NO_COLOUR, 0, NULL});
    else
        draw_line(sketch, ends, 2, &line);
    if (look->marks) plot_marks(sketch, &middle, 1, &look->style);
}

/* A legend in columns over [left, page width], the middle of its first row at `top`. Looks without a name are left out.
   */
static void draw_legend(Sketch *sketch, const PlotLook *looks, int count, int columns, double left, double top) {
    const double width = (sketch->width - left) / columns;
    for (int i = 0, shown = 0; i < count; i++) {
        if (looks[i].name == NULL) continue;
        const double x = left + width * (shown % columns), y = top - LEGEND_ROW * (shown / columns);
        draw_sample(sketch, &looks[i], x, y);
        const double room = width - LEGEND_SAMPLE - LEGEND_GAP - 0.5;
        plot_text(sketch, (Point){x + LEGEND_SAMPLE + LEGEND_GAP, y}, TEXT_LEFT,
                  text_points(looks[i].name, LEGEND_POINTS, room), looks[i].name);
        shown++;
    }
}

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

bool plot_level(PlotPoint *out, int i, double y) {
    *out = (PlotPoint){i == 0 ? -INFINITY : INFINITY, y, 0};
    return i < 2;
}

bool plot_upright(PlotPoint *out, int i, double x) {
    *out = (PlotPoint){x, i == 0 ? -INFINITY : INFINITY, 0};
    return i < 2;
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

static int compare(double a, double b) { return (a > b) - (a < b); }

static int by_place(const void *first, const void *second) {
    const PlotPoint *a = first, *b = second;
    const int order = compare(a->x, b->x);
    return order != 0 ? order : compare(a->y, b->y);
}

static int by_group(const void *first, const void *second) {
    const int order = compare(((const PlotPoint *)first)->group, ((const PlotPoint *)second)->group);
    return order != 0 ? order : by_place(first, second);
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

/* From bottom to top. */
typedef enum Pass { PASS_SEEDS, PASS_BELOW, PASS_ABOVE, PASSES } Pass;

static void draw_series(Plotter *plotter, int index, int series, Pass pass) {
    const PlotPanel *panel = &plotter->spec->panels[index];
    PlotPoint *points = plotter->points;
    PlotLook look = plotter->spec->looks[series];
    int count = 0, places = 0;
    /* The points, clamped to the axes. */
    for (int row = 0; row < plotter->spec->rows; row++) {
        PlotPoint point = {0};
        if (!plotter->spec->point(plotter->spec->of, index, series, row, &point)) continue;
        point.x = plot_axis_clamp(&panel->x, point.x, &plotter->beyond);
        point.y = plot_axis_clamp(&panel->y, point.y, &plotter->beyond);
        if (!isnan(point.x + point.y)) points[count++] = point;
    }
    if (count > 0) plotter->used[series] = true;
    if (count == 0 || (pass == PASS_SEEDS ? !look.seeds : look.above != (pass == PASS_ABOVE))) return;
    if (pass == PASS_SEEDS) {
        qsort(points, (size_t)count, sizeof *points, by_group);
        look.line = 0.6;
        look.style.dashes = NULL;
        look.marks = false;
    } else if (look.seeds || look.medians) {
        count = to_medians(points, count);
    }
    if (look.band) {
        const Pen pen = {look.style.colour, 1, NO_COLOUR, 0, NULL};
        if (count > 1)
            sketch_rectangle(plotter->sketch, plot_place(panel, points[0].x, points[0].y),
                             plot_place(panel, points[1].x, points[1].y), &pen);
        return;
    }
    if (look.stems) {
        const Pen pen = pen_line(look.style.colour, look.line, NULL);
        for (int i = 0; i < count; i++)
            sketch_line(plotter->sketch, plot_place(panel, points[i].x, 0), plot_place(panel, points[i].x, points[i].y),
                        &pen);
        look.line = 0;
    }
    for (int i = 0; i < count; i++) {
        if (i > 0 && points[i].group != points[i - 1].group) plotter->places[places++] = (Point){NAN, NAN};
        plotter->places[places++] = plot_place(panel, points[i].x, points[i].y);
    }
    draw_line(plotter->sketch, plotter->places, places, &look);
}

bool plot_draw(PlotPage *page, const PlotSpec *spec, const char *what, Error *error) {
    Plotter plotter = {.spec = spec, .sketch = &page->sketch};
    plotter.points = malloc((size_t)spec->rows * sizeof *plotter.points + 1);
    plotter.places = malloc(2 * (size_t)spec->rows * sizeof *plotter.places + 1);
    const bool room = plotter.points != NULL && plotter.places != NULL;
    sketch_begin(&page->sketch, spec->width, spec->height);
    for (int i = 0; room && i < spec->panel_count; i++) {
        if (spec->panels[i].box.width <= 0) continue;
        plot_panel_place(&spec->panels[i]);
        for (int pass = 0; pass < PASSES; pass++)
            for (int series = spec->series - 1; series >= 0; series--) draw_series(&plotter, i, series, (Pass)pass);
        plot_panel_draw(&page->sketch, &spec->panels[i]);
    }
    PlotLook shown[PLOT_SERIES];
    int count = 0;
    for (int series = 0; series < spec->series; series++)
        if (plotter.used[series]) shown[count++] = spec->looks[series];
    draw_legend(&page->sketch, shown, count, spec->legend_columns, spec->legend_left, spec->legend_top);
    snprintf(page->caption, sizeof page->caption, "%s%s\n", spec->caption,
             plotter.beyond ? " Values beyond an axis are drawn at its edge." : "");
    free(plotter.points);
    free(plotter.places);
    return (room && !page->sketch.failed) || error_memory(error, what);
}
