/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_labels.h"

#include "chart/chart_script.h"
#include "chart/chart_style.h"
#include "sketch/label_place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm; Inter's mean advance is 0.56 em. */
static const double character_width = LABEL_POINTS * 0.3528 * 0.56, label_height = LABEL_POINTS * 0.3528 * 0.9;

typedef struct Labels {
    const Chart *chart;
    const ChartPanel *panel;
    const LogAxis *x, *y;
    LabelField field;
    FILE *script;
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

static double mark_x(const Labels *labels, int i) { return log_axis_place(labels->x, labels->panel->marks[i].us); }

static double mark_y(const Labels *labels, int i) { return log_axis_place(labels->y, labels->panel->marks[i].error); }

static PageBox box_around(double x, double y, double radius) {
    return (PageBox){x - radius, y - radius, x + radius, y + radius};
}

static void add_obstacles(Labels *labels) {
    const ChartMark *marks = labels->panel->marks;
    for (int i = 0; i < labels->panel->count; i++) {
        double x = mark_x(labels, i), y = mark_y(labels, i);
        label_add_box(&labels->field, box_around(x, y, marks[i].shipped ? RING_RADIUS : MARK_RADIUS));
        label_add_segment(&labels->field, (Segment){log_axis_place(labels->x, marks[i].us_q1), y,
                                                    log_axis_place(labels->x, marks[i].us_q3), y});
        if (i > 0 && marks[i - 1].line == marks[i].line)
            label_add_segment(&labels->field, (Segment){mark_x(labels, i - 1), mark_y(labels, i - 1), x, y});
    }
}

/* The front is drawn behind everything, but labels on it are hard to read. */
static bool add_front(Labels *labels) {
    int *order = malloc((size_t)labels->panel->count * sizeof *order + 1);
    if (order == NULL) return false;
    int corners = chart_pareto_corners(labels->panel, order);
    for (int i = 0; i < corners; i++) {
        double x = mark_x(labels, order[i]), y = mark_y(labels, order[i]);
        double above = i > 0 ? mark_y(labels, order[i - 1]) : labels->y->to;
        double right = i + 1 < corners ? mark_x(labels, order[i + 1]) : labels->x->to;
        label_add_segment(&labels->field, (Segment){x, above, x, y});
        label_add_segment(&labels->field, (Segment){x, y, right, y});
    }
    free(order);
    return true;
}

/* A thin line from a mark's ring to its label, if they are apart. */
static void write_leader(FILE *script, double x, double y, const PageBox *box) {
    double near_x = fmin(fmax(x, box->left), box->right), near_y = fmin(fmax(y, box->bottom), box->top);
    double distance = sqrt((near_x - x) * (near_x - x) + (near_y - y) * (near_y - y));
    if (distance < RING_RADIUS + 1) return;
    double share = RING_RADIUS / distance;
    fprintf(script, "set arrow from screen %.5f,%.5f to screen %.5f,%.5f nohead lw 0.8 lc rgb 'black' front\n",
            (x + share * (near_x - x)) / CHART_WIDTH, (y + share * (near_y - y)) / CHART_HEIGHT, near_x / CHART_WIDTH,
            near_y / CHART_HEIGHT);
}

static void write_label(Labels *labels, int i, const char *text, bool must) {
    PageBox box;
    const ChartMark *mark = &labels->panel->marks[i];
    double x = mark_x(labels, i), y = mark_y(labels, i), width = character_width * (double)strlen(text);
    double distance = (mark->shipped ? RING_RADIUS : MARK_RADIUS) + 0.4;
    if (!label_place(&labels->field, x, y, distance, width, label_height, must, &box)) return;
    if (must) write_leader(labels->script, x, y, &box);
    fprintf(labels->script, "set label '%s' at screen %.5f,%.5f center font ',%g' tc rgb '%s'\n", text,
            (box.left + box.right) / 2 / CHART_WIDTH, (box.bottom + box.top) / 2 / CHART_HEIGHT, LABEL_POINTS,
            labels->chart->lines[mark->line].style.ink);
}

static bool ends_line(const ChartPanel *panel, int i) {
    const ChartMark *marks = panel->marks;
    return i == 0 || i + 1 == panel->count || marks[i - 1].line != marks[i].line || marks[i + 1].line != marks[i].line;
}

/* Settings as shipped must be labelled; then marks on the front come first. */
static void write_labels(Labels *labels) {
    const ChartPanel *panel = labels->panel;
    for (int i = 0; i < panel->count; i++)
        if (panel->marks[i].shipped) {
            char text[CHART_TEXT_SIZE + 16];
            snprintf(text, sizeof text, "%s as shipped", labels->chart->lines[panel->marks[i].line].name);
            write_label(labels, i, text, true);
        }
    for (int front = 1; front >= 0; front--)
        for (int i = 0; i < panel->count; i++) {
            const ChartMark *mark = &panel->marks[i];
            if (mark->on_front != (front == 1) || mark->shipped || !ends_line(panel, i)) continue;
            const char *text = mark->label[0] != '\0' ? mark->label : labels->chart->lines[mark->line].name;
            write_label(labels, i, text, false);
        }
}

bool chart_write_labels(const ChartPanel *panel, const Chart *chart, const LogAxis *x, const LogAxis *y, FILE *script) {
    Labels *labels = calloc(1, sizeof *labels);
    if (labels == NULL) return false;
    *labels = (Labels){chart, panel, x, y, {.frame = {x->from + 0.5, y->from + 0.5, x->to - 0.5, y->to - 0.5}}, script};
    add_obstacles(labels);
    bool whole = add_front(labels);
    if (whole) write_labels(labels);
    free(labels);
    return whole;
}
