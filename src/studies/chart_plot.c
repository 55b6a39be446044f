/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of speed against accuracy: few curves in colour, each named where it ends, all others grey; what no solver
   reaches is shaded. */
#include "base/base.h"
#include "base/file.h"
#include "figures/labels.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "studies/chart_data.h"
#include "studies/chart_drawing.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/statistics.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The layout of a chart, in mm from the page's lower left corner. */

#define LEFT_MARGIN 15.0
#define RIGHT_MARGIN 3.5 /* half of "1000" below an axis that ends there */
#define TOP_MARGIN 10.5
#define BOTTOM_MARGIN 9.0

#define AXIS_POINTS 7.5

#define GREY_LINE 0xB9BFC7u
#define SHADE 0xEEF1F5u

static const struct {
    double width, height, gap, row_gap;
    int columns;
} pages[] = {[CHART_PAGE] = {FIGURE_PAGE_WIDTH, 92, 8, 0, 2},
             [CHART_COLUMN] = {FIGURE_COLUMN_WIDTH, 144, 0, 15, 1},
             [CHART_SLIDE] = {160, 90, 8, 0, 2}};

static const char *const panel_titles[CHART_PANELS] = {"At the impact", "In the 60 frames after it"};

/* A drawn chart. */
typedef struct ChartPicture {
    const Chart *chart;
    ChartSize size;
    double width, height; /* mm */
    PlotPanel panels[CHART_PANELS];
    bool named[CHART_MAX_LINES]; /* in a panel */
    Sketch sketch;
    char caption[PLOT_CAPTION_SIZE];
} ChartPicture;

/* words: mm that the caption takes below. */
static void lay_out(ChartPicture *picture, double words) {
    const ChartSize size = picture->size;
    const Chart *chart = picture->chart;
    picture->width = pages[size].width;
    picture->height = pages[size].height + words;
    const PlotGrid grid = {.width = picture->width,
                           .height = picture->height,
                           .left = LEFT_MARGIN,
                           .right = RIGHT_MARGIN,
                           .bottom = BOTTOM_MARGIN + words,
                           .top = TOP_MARGIN,
                           .columns = pages[size].columns,
                           .rows = CHART_PANELS / pages[size].columns,
                           .gap = pages[size].gap,
                           .row_gap = pages[size].row_gap};
    for (int p = 0; p < CHART_PANELS; p++) {
        const char *error_axis = p == 0 || pages[size].columns == 1 ? "Mean velocity error (m/s)" : NULL;
        picture->panels[p] =
            (PlotPanel){.box = plot_grid_box(&grid, p),
                        .title = panel_titles[p],
                        .x = plot_log_axis(chart->us_least, chart->us_most, "Solver time per step (µs)"),
                        .y = plot_log_axis(chart->error_least, chart->error_most, error_axis),
                        .points = AXIS_POINTS};
        plot_panel_place(&picture->panels[p]);
    }
}

/* A silenced twin has a shade of its method's colour, dashed and open; an external program is open, too. */
PlotStyle chart_line_style(const ChartLine *line) {
    PlotStyle style = {.symbol = METHOD_CIRCLE, .colour = GREY_LINE, .ink = CHART_GREY_INK};
    if (line->rank != CHART_COLOURED) return style;
    style = plot_method_style(&line->colours);
    const bool twin = chart_twin_word(line) != NULL;
    style.symbol = METHOD_CIRCLE;
    style.open = twin || chart_is_program(line);
    style.dashes = twin ? "(5,2.5)" : NULL;
    return style;
}

/* Shade, curves and marks. */

/* The corners of the front, from the upper edge of the panel to its right one. Returns their number. */
static int front_corners(const ChartDrawing *drawing, int panel, Point *corners) {
    const CurvePoint *front = drawing->chart->front[panel];
    const PlotBox *box = &drawing->plot->box;
    const double right = box->left + box->width, top = box->bottom + box->height;
    int count = 0;
    double y = top;
    for (int i = 0; i < drawing->chart->front_count[panel]; i++) {
        const Point at = plot_place(drawing->plot, front[i].us, front[i].error);
        const double x = fmin(fmax(at.x, box->left), right);
        corners[count++] = (Point){x, y};
        y = fmin(fmax(at.y, box->bottom), top);
        corners[count++] = (Point){x, y};
    }
    if (count > 0) corners[count++] = (Point){right, y};
    return count;
}

static bool draw_shade(const ChartDrawing *drawing, int panel) {
    const PlotBox *box = &drawing->plot->box;
    Point *corners = malloc((2 * (size_t)drawing->chart->front_count[panel] + 4) * sizeof *corners);
    if (corners == NULL) return false;
    int count = front_corners(drawing, panel, corners);
    if (count > 0) {
        corners[count++] = (Point){box->left + box->width, box->bottom};
        corners[count++] = (Point){box->left, box->bottom};
        corners[count++] = (Point){box->left, box->bottom + box->height};
        sketch_shape(drawing->sketch, corners, count, &(Pen){SHADE, 1, NO_COLOUR, 0, NULL});
    }
    free(corners);
    return true;
}

const ChartMark *chart_find_baseline(const ChartPanel *panel) {
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].baseline) return &panel->marks[i];
    return NULL;
}

/* Marks of a line follow each other. One that is lost or beaten is joined to none. */
static void draw_curve(ChartDrawing *drawing, int first, int end) {
    const ChartMark *marks = drawing->panel->marks;
    const bool coloured = chart_is_coloured(drawing, &marks[first]);
    const PlotStyle style = chart_line_style(chart_line_of(drawing, &marks[first]));
    const Pen pen = pen_line(style.colour, coloured ? 2.4 : 0.9, style.dashes);
    const ChartMark *before = NULL;
    for (int i = first; i < end; i++) {
        if (marks[i].lost || marks[i].beaten) continue;
        const Point to = chart_place(drawing, &marks[i]), from = before != NULL ? chart_place(drawing, before) : to;
        before = &marks[i];
        sketch_line(drawing->sketch, from, to, &pen);
        label_add_segment(&drawing->field, (Segment){from.x, from.y, to.x, to.y});
    }
}

static void draw_mark(ChartDrawing *drawing, const ChartMark *mark) {
    PlotStyle style = chart_line_style(chart_line_of(drawing, mark));
    const Point at = chart_place(drawing, mark);
    const bool coloured = chart_is_coloured(drawing, mark);
    const double radius = mark->baseline ? CHART_RING_RADIUS : coloured ? MARK_RADIUS : CHART_GREY_RADIUS;
    if (mark->lost) style.symbol = PLOT_CROSS;
    if (coloured)
        plot_marks(drawing->sketch, &at, 1, &style);
    else
        plot_mark(drawing->sketch, at, &style, CHART_GREY_RADIUS, 0);
    if (mark->baseline)
        plot_mark(drawing->sketch, at, &(PlotStyle){.symbol = METHOD_CIRCLE, .open = true, .colour = ACCENT},
                  CHART_RING_RADIUS, 2);
    label_add_box(&drawing->field, (PageBox){at.x - radius, at.y - radius, at.x + radius, at.y + radius});
}

/* False if out of memory. */
static bool draw_panel(ChartPicture *picture, int panel) {
    const PlotPanel *plot = &picture->panels[panel];
    ChartDrawing *drawing = calloc(1, sizeof *drawing);
    if (drawing == NULL) return false;
    *drawing =
        (ChartDrawing){.chart = picture->chart,
                       .panel = &picture->chart->panels[panel],
                       .plot = plot,
                       .sketch = &picture->sketch,
                       .field = {.frame = {plot->x.from + 0.5, plot->y.from + 0.5, plot->x.to - 0.5, plot->y.to - 0.5}},
                       .named = picture->named};
    const bool whole = draw_shade(drawing, panel);
    if (whole) {
        chart_find_cross(drawing);
        const double floor = picture->chart->floor[panel];
        if (floor > 0) {
            const double y = plot_axis_place(&plot->y, floor), right = plot->box.left + plot->box.width;
            const Pen pen = pen_line(CHART_GREY_INK, 0.8, NULL);
            sketch_line(drawing->sketch, (Point){plot->box.left, y}, (Point){right, y}, &pen);
            label_add_segment(&drawing->field, (Segment){plot->box.left, y, right, y});
        }
        /* Grey below colour, curves below marks. */
        const ChartMark *marks = drawing->panel->marks;
        const int count = drawing->panel->count;
        for (int coloured = 0; coloured <= 1; coloured++) {
            for (int i = 0, end; i < count; i = end) {
                for (end = i; end < count && marks[end].line == marks[i].line;) end++;
                if (chart_is_coloured(drawing, &marks[i]) == (coloured == 1)) draw_curve(drawing, i, end);
            }
            for (int i = 0; i < count; i++)
                if (chart_is_coloured(drawing, &marks[i]) == (coloured == 1)) draw_mark(drawing, &marks[i]);
        }
        chart_draw_names(drawing, panel);
        plot_panel_draw(&picture->sketch, plot);
    }
    free(drawing);
    return whole;
}

/* Right of the title, from `left` on: the methods that no panel shows, and why, as far as there is room. */
static void draw_left_out(ChartPicture *picture, double left) {
    const Chart *chart = picture->chart;
    const double right = picture->width - RIGHT_MARGIN;
    char text[PLOT_CAPTION_SIZE] = "", next[PLOT_CAPTION_SIZE];
    int more = 0;
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        const char *why = line->lost > 0       ? "unstable"
                          : line->left_out > 0 ? "no time or error"
                          : line->beyond > 0   ? "beyond the axes"
                                               : NULL;
        if (why == NULL || line->marks[0] + line->marks[1] > 0 || line->rank == CHART_HIDDEN) continue;
        strcpy(next, text);
        text_add(next, sizeof next, "%s%s (%s)", text[0] == '\0' ? "left out: " : ", ", line->name, why);
        if (more == 0 &&
            left + type_width(next, CHART_SMALL_POINTS) + type_width(", 99 more", CHART_SMALL_POINTS) < right)
            strcpy(text, next);
        else
            more++;
    }
    if (more > 0 && text[0] != '\0')
        text_add(text, sizeof text, ", %d more", more);
    else if (more > 0)
        snprintf(text, sizeof text, "left out: %d method%s", more, plural(more));
    const TextStyle style = {CHART_SMALL_POINTS, TEXT_RIGHT, CHART_GREY_INK, 0, false};
    if (text[0] != '\0') sketch_text(&picture->sketch, (Point){right, picture->height - 3}, &style, "%s", text);
}

/* Everything but the caption's words below. */
static bool draw_panels(ChartPicture *picture, const char *title, double words) {
    bool whole = true;
    lay_out(picture, words);
    sketch_begin(&picture->sketch, picture->width, picture->height);
    for (int p = 0; whole && p < CHART_PANELS; p++) whole = draw_panel(picture, p);
    const TextStyle style = {AXIS_POINTS, TEXT_LEFT, CHART_GREY_INK, 0, false};
    sketch_text(&picture->sketch, (Point){LEFT_MARGIN, picture->height - 3}, &style, "%s", title);
    draw_left_out(picture, LEFT_MARGIN + type_width(title, AXIS_POINTS) + 6);
    return whole;
}

/* Names that find no place are known when the panels are drawn, and the height of the caption after that. */
static bool draw_words(ChartPicture *picture, const char *title) {
    char lines[sizeof picture->caption];
    const double gap = 2, row = line_height(CHART_SMALL_POINTS);
    snprintf(lines, sizeof lines, "%.*s", (int)strcspn(picture->caption, "\n"), picture->caption);
    const double words =
        gap + row * text_wrap(lines, sizeof lines, CHART_SMALL_POINTS, picture->width - LEFT_MARGIN - RIGHT_MARGIN);
    sketch_free(&picture->sketch);
    if (!draw_panels(picture, title, words)) return false;
    plot_text(&picture->sketch, (Point){LEFT_MARGIN, words - gap - row / 2}, TEXT_LEFT, CHART_SMALL_POINTS, lines);
    return true;
}

/* To be freed with sketch_free(). False with error set if out of memory. */
static bool make_picture(ChartPicture *picture, const Chart *chart, const char *scene, const ChartLook *look,
                         Error *error) {
    char name[CHART_TEXT_SIZE], title[2 * CHART_TEXT_SIZE];
    *picture = (ChartPicture){.chart = chart, .size = look->size};
    chart_plain(name, scene);
    snprintf(title, sizeof title, "%s, %d launch%s%s", name, chart->launches, plural_es(chart->launches),
             chart->frozen ? ", on the engine's steps" : "");
    bool whole = draw_panels(picture, title, 0);
    chart_caption(chart, title, picture->named, picture->caption, sizeof picture->caption);
    if (whole && look->words) whole = draw_words(picture, title);
    snprintf(picture->sketch.title, sizeof picture->sketch.title, "Speed and accuracy: %s", title);
    if (whole) return true;
    sketch_free(&picture->sketch);
    return error_memory(error, scene);
}

bool chart_plot(const char *csv_path, const char *scene, const char *folder, const ChartLook *look, Error *error) {
    char stem[PATH_MAX], caption[PATH_MAX];
    if (scene[0] == '\0' || strchr(scene, '/') != NULL) /* another's table must not make us write outside the folder */
        return error_input(error, csv_path, "'%s' is not a valid scene name", scene);
    if (!file_path(stem, sizeof stem, error, "%s/chart-%s", folder, scene) ||
        !file_path(caption, sizeof caption, error, "%s.txt", stem))
        return false;
    CsvTable table;
    if (!csv_table_read(&table, csv_path, &chart_layout, error)) return false;
    Chart chart;
    ChartPicture picture;
    bool drawn = chart_gather(&chart, &table, scene, csv_path, look, error);
    if (drawn) {
        drawn = make_picture(&picture, &chart, scene, look, error);
        if (drawn) {
            drawn = sketch_draw(&picture.sketch, stem, SKETCH_PDF, error) &&
                    file_write(caption, picture.caption, strlen(picture.caption), error);
            sketch_free(&picture.sketch);
        }
        chart_free(&chart);
    }
    csv_table_free(&table);
    return drawn;
}
