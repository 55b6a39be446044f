/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_layout.h"

#include "sketch/label_place.h"
#include "type/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double label_height = LABEL_POINTS * MM_PER_POINT * 0.9;

typedef struct Labels {
    const Chart *chart;
    const ChartPanel *panel;
    const PlotPanel *plot;
    LabelField field;
    Sketch *sketch;
} Labels;

int chart_pareto_corners(const ChartPanel *panel, int *order) {
    int count = 0;
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].on_front) order[count++] = i;
    /* Insertion sort: a front is short, and its lines are sorted already. */
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && panel->marks[order[k]].us < panel->marks[order[k - 1]].us; k--) {
            int swap = order[k];
            order[k] = order[k - 1];
            order[k - 1] = swap;
        }
    int corners = 0;
    for (int i = 0; i < count; i++)
        if (corners == 0 || panel->marks[order[i]].error < panel->marks[order[corners - 1]].error)
            order[corners++] = order[i];
    return corners;
}

static Point mark_at(const Labels *labels, int i) {
    return plot_place(labels->plot, labels->panel->marks[i].us, labels->panel->marks[i].error);
}

static void add_obstacles(Labels *labels) {
    const ChartMark *marks = labels->panel->marks;
    for (int i = 0; i < labels->panel->count; i++) {
        const Point at = mark_at(labels, i), before = mark_at(labels, i > 0 ? i - 1 : i);
        const double radius = marks[i].shipped ? RING_RADIUS : MARK_RADIUS;
        label_add_box(&labels->field, (PageBox){at.x - radius, at.y - radius, at.x + radius, at.y + radius});
        label_add_segment(&labels->field, (Segment){plot_axis_place(&labels->plot->x, marks[i].us_q1), at.y,
                                                    plot_axis_place(&labels->plot->x, marks[i].us_q3), at.y});
        if (i > 0 && marks[i - 1].line == marks[i].line)
            label_add_segment(&labels->field, (Segment){before.x, before.y, at.x, at.y});
    }
}

/* The front is drawn behind everything, but labels on it are hard to read. */
static bool add_front(Labels *labels) {
    int *order = malloc((size_t)labels->panel->count * sizeof *order + 1);
    if (order == NULL) return false;
    int corners = chart_pareto_corners(labels->panel, order);
    for (int i = 0; i < corners; i++) {
        const Point at = mark_at(labels, order[i]);
        const double above = i > 0 ? mark_at(labels, order[i - 1]).y : labels->plot->y.to;
        const double right = i + 1 < corners ? mark_at(labels, order[i + 1]).x : labels->plot->x.to;
        label_add_segment(&labels->field, (Segment){at.x, above, at.x, at.y});
        label_add_segment(&labels->field, (Segment){at.x, at.y, right, at.y});
    }
    free(order);
    return true;
}

/* A thin line from a mark's ring to its label, if they are apart. */
static void draw_leader(Sketch *sketch, Point at, const PageBox *box) {
    const Point near = {fmin(fmax(at.x, box->left), box->right), fmin(fmax(at.y, box->bottom), box->top)};
    const double distance = hypot(near.x - at.x, near.y - at.y), share = RING_RADIUS / distance;
    if (distance < RING_RADIUS + 1) return;
    const Pen pen = pen_line(0x000000, 0.8, NULL);
    sketch_line(sketch, (Point){at.x + share * (near.x - at.x), at.y + share * (near.y - at.y)}, near, &pen);
}

static void draw_label(Labels *labels, int i, const char *text, bool must) {
    PageBox box;
    const ChartMark *mark = &labels->panel->marks[i];
    const Point at = mark_at(labels, i);
    const double width = type_width(text, LABEL_POINTS);
    const double distance = (mark->shipped ? RING_RADIUS : MARK_RADIUS) + 0.4;
    if (!label_place(&labels->field, at.x, at.y, distance, width, label_height, must, &box)) return;
    if (must) draw_leader(labels->sketch, at, &box);
    const TextStyle style = {LABEL_POINTS, TEXT_CENTER, labels->chart->lines[mark->line].style.ink, 0, false};
    sketch_text(labels->sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2}, &style, "%s", text);
}

static bool ends_line(const ChartPanel *panel, int i) {
    const ChartMark *marks = panel->marks;
    return i == 0 || i + 1 == panel->count || marks[i - 1].line != marks[i].line || marks[i + 1].line != marks[i].line;
}

/* Settings as shipped must be labelled; then marks on the front come first. */
static void draw_labels(Labels *labels) {
    const ChartPanel *panel = labels->panel;
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].shipped) {
            char text[CHART_TEXT_SIZE + 16];
            snprintf(text, sizeof text, "%s as shipped", labels->chart->lines[panel->marks[i].line].name);
            draw_label(labels, i, text, true);
        }
    for (int front = 1; front >= 0; front--)
        for (int i = 0; i < panel->count; i++) {
            const ChartMark *mark = &panel->marks[i];
            if (mark->on_front != (front == 1) || mark->shipped || !ends_line(panel, i)) continue;
            const char *text = mark->label[0] != '\0' ? mark->label : labels->chart->lines[mark->line].name;
            draw_label(labels, i, text, false);
        }
}

bool chart_draw_labels(const ChartLayout *layout, int panel, Sketch *sketch) {
    const PlotPanel *plot = &layout->panels[panel];
    const PageBox frame = {plot->x.from + 0.5, plot->y.from + 0.5, plot->x.to - 0.5, plot->y.to - 0.5};
    Labels *labels = calloc(1, sizeof *labels);
    if (labels == NULL) return false;
    *labels = (Labels){layout->chart, &layout->chart->panels[panel], plot, {.frame = frame}, sketch};
    add_obstacles(labels);
    bool whole = add_front(labels);
    if (whole) draw_labels(labels);
    free(labels);
    return whole;
}
