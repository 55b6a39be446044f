/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of the curves in a chart, where there is room beside them, and the lines through the baseline, which
   they interrupt. */
#include "figures/labels.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "pixels/type.h"
#include "studies/chart_data.h"
#include "studies/chart_drawing.h"
#include "studies/figure_words.h"

#include <math.h>
#include <string.h>

enum { LABEL_ROWS = 4, CROSS = 2 };

typedef struct Label {
    char rows[LABEL_ROWS][CHART_TEXT_SIZE + 40];
    int count;
    double points[LABEL_ROWS];
    uint32_t ink;
} Label;

/* mm: between a label and what is beyond its end. */
static const double label_gap = 0.8;

static double row_height(double points) { return 1.2 * points * MM_PER_POINT; }

static void label_row(Label *label, double points, const char *text) {
    if (label->count == LABEL_ROWS || text[0] == '\0') return;
    snprintf(label->rows[label->count], sizeof label->rows[0], "%s", text);
    label->points[label->count++] = points;
}

static void draw_label(const ChartDrawing *drawing, const Label *label, const PageBox *box, bool right) {
    if (drawing->sketch == NULL) return;
    double y = box->top;
    for (int i = 0; i < label->count; i++) {
        const TextStyle style = {label->points[i], right ? TEXT_RIGHT : TEXT_LEFT, label->ink, 0, false};
        y -= row_height(label->points[i]) / 2;
        sketch_text(drawing->sketch, (Point){right ? box->right : box->left, y}, &style, "%s", label->rows[i]);
        y -= row_height(label->points[i]) / 2;
    }
}

/* At the mark, or led to it by a thin line at most so long; across a line of the cross only if there is no other
   place. */
static bool place_label(ChartDrawing *drawing, const ChartMark *mark, const Label *label, double farthest) {
    const Point at = chart_place(drawing, mark);
    LabelWish wish = {.x = at.x,
                      .y = at.y,
                      .clear = mark->baseline                     ? CHART_RING_RADIUS
                               : chart_is_coloured(drawing, mark) ? MARK_RADIUS
                                                                  : CHART_GREY_RADIUS,
                      .farthest = farthest,
                      .across = drawing->bare};
    for (int i = 0; i < label->count; i++) {
        wish.width = fmax(wish.width, type_width(label->rows[i], label->points[i]) + label_gap);
        wish.height += row_height(label->points[i]);
    }
    PageBox box;
    Segment leader;
    bool led;
    if (!label_place_led(&drawing->field, &wish, &box, &leader, &led)) {
        Segment cross[CROSS];
        memcpy(cross, drawing->field.segments, sizeof cross);
        memset(drawing->field.segments, 0, sizeof cross);
        const bool placed = label_place_led(&drawing->field, &wish, &box, &leader, &led);
        memcpy(drawing->field.segments, cross, sizeof cross);
        if (!placed) return false;
    }
    if (led && drawing->sketch != NULL) {
        const Pen pen = pen_line(label->ink, 0.6, NULL);
        sketch_line(drawing->sketch, (Point){leader.x0, leader.y0}, (Point){leader.x1, leader.y1}, &pen);
    }
    draw_label(drawing, label, &box, (box.left + box.right) / 2 < at.x);
    return true;
}

/* A row "3.8 × the time", "1/980 of the error". */
static void label_factor(Label *label, double factor, const char *of) {
    char text[48], number[FACTOR_SIZE];
    factor_text(number, factor < 1 ? 1 / factor : factor);
    snprintf(text, sizeof text, factor < 1 ? "1/%s of the %s" : "%s × the %s", number, of);
    label_row(label, CHART_SMALL_POINTS, text);
}

/* The mark that stands for a line: the baseline or its default setting, else the most accurate one. */
static const ChartMark *find_chief(const ChartDrawing *drawing, int line) {
    const ChartMark *chief = NULL;
    for (int i = 0; i < drawing->panel->count; i++) {
        const ChartMark *mark = &drawing->panel->marks[i];
        if (mark->line != line || mark->lost) continue;
        if (mark->baseline || chart_mark_is_default(mark)) return mark;
        if (chief == NULL || mark->error < chief->error) chief = mark;
    }
    return chief;
}

/* The name of a coloured line; of a mark, how its setting stands to the baseline. */
static Label label_of(const ChartDrawing *drawing, int line, const ChartMark *mark) {
    const ChartMark *baseline = chart_find_baseline(drawing->panel);
    Label label = {.ink = chart_line_style(&drawing->chart->lines[line]).ink};
    /* A silenced twin stands beside its method, in its colour: "net=off". */
    const char *word = chart_twin_word(&drawing->chart->lines[line]);
    label_row(&label, CHART_NAME_POINTS, word != NULL ? word : drawing->chart->lines[line].name);
    if (mark == NULL || mark == baseline) return label;
    label_row(&label, CHART_SMALL_POINTS, mark->label);
    if (baseline != NULL && line != baseline->line && !chart_is_program(&drawing->chart->lines[line])) {
        label_factor(&label, mark->us / baseline->us, "time,");
        label_factor(&label, mark->error / baseline->error, "error");
    }
    return label;
}

/* At the chief mark of a line, else at another one, the most accurate first: with what is to say of that mark, or the
   name alone. */
static const ChartMark *name_mark(ChartDrawing *drawing, const ChartMark *chief, bool whole) {
    const double farthest = drawing->bare ? 60 : 12; /* the chief mark's name may be led to it from twice as far */
    for (double far = 3; far <= farthest; far *= 2)
        for (int i = drawing->panel->count; i >= 0; i--) {
            const ChartMark *mark = i == drawing->panel->count ? chief : &drawing->panel->marks[i];
            if (mark->line != chief->line || mark->lost) continue;
            const Label label = label_of(drawing, chief->line, whole ? mark : NULL);
            if (place_label(drawing, mark, &label, mark == chief ? 2 * farthest : far)) return mark;
        }
    return NULL;
}

/* The most accurate first: below them is room. Whether each has a place for its name. */
static bool name_coloured(ChartDrawing *drawing) {
    bool named[CHART_MAX_LINES] = {false}, all = true;
    for (;;) {
        const ChartMark *chief = NULL;
        int next = -1;
        for (int i = 0; i < drawing->chart->line_count; i++) {
            if (drawing->chart->lines[i].rank != CHART_COLOURED || named[i]) continue;
            const ChartMark *mark = find_chief(drawing, i);
            named[i] = mark == NULL;
            if (mark != NULL && (chief == NULL || mark->error < chief->error)) next = i, chief = mark;
        }
        if (next < 0) return all;
        named[next] = true;
        const ChartMark *told = drawing->bare ? NULL : name_mark(drawing, chief, true);
        const bool placed = told != NULL || name_mark(drawing, chief, false) != NULL;
        drawing->told[next] = told;
        drawing->named[next] |= placed;
        all = all && placed;
    }
}

/* The ends of a grey line: the last mark is the most accurate one. */
static void name_grey(ChartDrawing *drawing, int index) {
    const ChartLine *line = &drawing->chart->lines[index];
    Label label = {.ink = CHART_GREY_INK};
    const ChartMark *first = NULL, *last = NULL;
    for (int i = 0; i < drawing->panel->count; i++)
        if (drawing->panel->marks[i].line == index) {
            last = &drawing->panel->marks[i];
            if (first == NULL) first = last;
        }
    if (last == NULL) return;
    label_row(&label, CHART_SMALL_POINTS, line->name);
    bool placed = false;
    for (double far = 2; !placed && far <= 9; far += 3.5)
        placed = place_label(drawing, last, &label, far) || place_label(drawing, first, &label, far);
    drawing->named[index] |= placed;
}

/* The quickest and the most accurate setting of a coloured line, where its name does not tell of them. */
static void name_settings(ChartDrawing *drawing, int index) {
    const ChartPanel *panel = drawing->panel;
    for (int i = 0; i < panel->count; i++) {
        const ChartMark *mark = &panel->marks[i];
        const bool first = i == 0 || panel->marks[i - 1].line != index;
        const bool last = i + 1 == panel->count || panel->marks[i + 1].line != index;
        if (mark->line != index || !(first || last) || mark == drawing->told[index] || mark->baseline) continue;
        Label label = {.ink = chart_line_style(&drawing->chart->lines[index]).ink};
        label_row(&label, CHART_SMALL_POINTS, mark->label);
        place_label(drawing, mark, &label, 1.8);
    }
}

static bool draw_names(ChartDrawing *drawing) {
    const Chart *chart = drawing->chart;
    const ChartMark *baseline = chart_find_baseline(drawing->panel);
    if (baseline != NULL) {
        Label label = {.ink = ACCENT};
        label_row(&label, CHART_SMALL_POINTS, "the scene's sweeps");
        place_label(drawing, baseline, &label, 20);
    }
    const bool all = name_coloured(drawing);
    for (int i = 0; i < chart->line_count; i++)
        if (chart->lines[i].rank == CHART_COLOURED && !drawing->bare) name_settings(drawing, i);
    for (int i = 0; i < chart->line_count; i++)
        if (chart->lines[i].rank == CHART_GREY) name_grey(drawing, i);
    return all;
}

/* Time and error of the baseline, across the panel. */
void chart_find_cross(ChartDrawing *drawing) {
    const ChartMark *baseline = chart_find_baseline(drawing->panel);
    const PlotBox *box = &drawing->plot->box;
    Segment cross[CROSS] = {0};
    if (baseline != NULL) {
        const Point at = chart_place(drawing, baseline);
        cross[0] = (Segment){at.x, box->bottom, at.x, box->bottom + box->height};
        cross[1] = (Segment){box->left, at.y, box->left + box->width, at.y};
    }
    for (int i = 0; i < CROSS; i++) label_add_segment(&drawing->field, cross[i]);
}

/* The next place from `from` on along a line of the cross where a label begins, and where that ends. */
static double next_label(const ChartDrawing *drawing, const Segment *line, double from, double *end) {
    const bool upright = line->x0 == line->x1;
    const double to = upright ? line->y1 : line->x1;
    double begin = *end = to;
    for (int i = drawing->marks; i < drawing->field.box_count; i++) {
        const PageBox *box = &drawing->field.boxes[i];
        const double low = upright ? box->bottom : box->left, high = upright ? box->top : box->right;
        const bool across =
            upright ? box->left < line->x0 && line->x0 < box->right : box->bottom < line->y0 && line->y0 < box->top;
        if (across && high > from && low < begin) begin = low, *end = high;
    }
    return fmax(begin, from);
}

/* Interrupted by labels. */
static void draw_cross(const ChartDrawing *drawing) {
    const ChartMark *baseline = chart_find_baseline(drawing->panel);
    if (baseline == NULL) return;
    const Pen pen = pen_line(chart_line_style(chart_line_of(drawing, baseline)).colour, 0.7, "(1.2,2.4)");
    for (int i = 0; i < CROSS; i++) {
        const Segment *line = &drawing->field.segments[i];
        const bool upright = line->x0 == line->x1;
        for (double from = upright ? line->y0 : line->x0, to, end; from < (upright ? line->y1 : line->x1); from = end) {
            to = next_label(drawing, line, from, &end);
            if (to > from)
                sketch_line(drawing->sketch, upright ? (Point){line->x0, from} : (Point){from, line->y0},
                            upright ? (Point){line->x0, to} : (Point){to, line->y0}, &pen);
        }
    }
}

/* At the left edge, where the shade is widest, at most so far from y, if there is room. */
static void name_at_edge(ChartDrawing *drawing, const char *text, double y, double farthest) {
    const double width = type_width(text, CHART_SMALL_POINTS), height = row_height(CHART_SMALL_POINTS);
    LabelWish wish = {.x = drawing->plot->box.left + 2, .y = y, .farthest = farthest, .width = width, .height = height};
    Label label = {.ink = CHART_GREY_INK};
    PageBox at;
    Segment leader;
    bool led;
    label_row(&label, CHART_SMALL_POINTS, text);
    if (label_place_led(&drawing->field, &wish, &at, &leader, &led)) draw_label(drawing, &label, &at, false);
}

void chart_draw_names(ChartDrawing *drawing, int panel) {
    drawing->marks = drawing->field.box_count;
    const double floor = drawing->chart->floor[panel], row = row_height(CHART_SMALL_POINTS);
    if (floor > 0) name_at_edge(drawing, "floor", plot_axis_place(&drawing->plot->y, floor), 12);
    /* Tried first: where a coloured curve finds no place for its name, all that stands beside the names goes. */
    Sketch *sketch = drawing->sketch;
    drawing->tried = drawing->field;
    drawing->sketch = NULL;
    drawing->bare = !draw_names(drawing);
    drawing->field = drawing->tried;
    drawing->sketch = sketch;
    draw_names(drawing);
    if (drawing->chart->front_count[panel] > 0)
        name_at_edge(drawing, "no solver gets here", drawing->plot->box.bottom + 1.5 + row / 2, 3);
    draw_cross(drawing);
}
