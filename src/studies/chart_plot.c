/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of speed against accuracy: legend, labels of marks, lines and the Pareto front. */
#include "base/base.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "studies/chart.h"
#include "studies/chart_internal.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The layout of a chart, in mm from the page's lower left corner: two panels side by side and a legend below. */

#define LEFT_MARGIN 16.5
#define RIGHT_MARGIN 3.5 /* half of "1000" below an axis that ends there */
#define FOOT_ROW WORD_ROW
#define FOOT_GAP 1.2
#define LEAST_PANEL 56.0 /* height */

#define LABEL_POINTS 6.5
#define RING_RADIUS 2.2 /* mm: around a setting as shipped */

enum { CHART_NOTES = 7 };

typedef struct ChartLayout {
    const Chart *chart;
    double height; /* mm, of the page */
    PlotPanel panels[CHART_PANELS];
    int columns, rows;                         /* of the legend */
    double legend_top;                         /* mm, middle of the first row */
    WordList words;                            /* below the legend */
    int foot_rows;                             /* notes below the words, from the bottom */
    char notes[CHART_NOTES][SKETCH_TEXT_SIZE]; /* one line each */
} ChartLayout;

/* The legend and its notes. */

static const char front_name[] = "Pareto front of solvers";

static bool is_drawn(const ChartLine *line) { return line->marks[0] + line->marks[1] > 0; }

/* Lists the lines with a nonzero counter (at `offset` in ChartLine), as far as there is room. */
static void write_counts(char note[SKETCH_TEXT_SIZE], const Chart *chart, const char *why, size_t offset) {
    enum { ROOM = 52 };
    const char *separator = why;
    size_t length = 0;
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        int count;
        memcpy(&count, (const char *)line + offset, sizeof count);
        if (count == 0) continue;
        length += strlen(line->name) + 6;
        if (length > ROOM) {
            text_add(note, SKETCH_TEXT_SIZE, " and others. ");
            return;
        }
        text_add(note, SKETCH_TEXT_SIZE, "%s%s (%d)", separator, line->name, count);
        separator = ", ";
    }
    if (separator != why) text_add(note, SKETCH_TEXT_SIZE, ". ");
}

/* "0.14 to 0.28 m/s"; one number if both are equal. */
static void write_range(char note[SKETCH_TEXT_SIZE], const double range[2], const char *unit) {
    text_add(note, SKETCH_TEXT_SIZE, range[0] < 100 ? "%.2g" : "%.0f", range[0]);
    if (range[1] > range[0]) text_add(note, SKETCH_TEXT_SIZE, range[1] < 100 ? " to %.2g" : " to %.0f", range[1]);
    text_add(note, SKETCH_TEXT_SIZE, " %s", unit);
}

static void write_times(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    text_add(note, SKETCH_TEXT_SIZE, "%s", chart->times);
}

static void write_varying(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    write_counts(note, chart, "Times here that vary: ", offsetof(ChartLine, varying));
}

static void write_beyond(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    const char *separator = "Beyond the axes: ";
    for (int i = 0; i < chart->line_count; i++) {
        const ChartLine *line = &chart->lines[i];
        if (line->beyond == 0) continue;
        text_add(note, SKETCH_TEXT_SIZE, "%s%s (", separator, line->name);
        write_range(note, line->beyond_us, "µs,");
        text_add(note, SKETCH_TEXT_SIZE, " ");
        if (line->beyond_error[1] <= PARETO_RESOLUTION) text_add(note, SKETCH_TEXT_SIZE, "below ");
        write_range(note, line->beyond_error, "m/s)");
        separator = ", ";
    }
}

static void write_no_push_out(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    const char *separator = "";
    for (int i = 0; i < chart->line_count; i++) {
        if (!chart->lines[i].no_push_out || !is_drawn(&chart->lines[i])) continue;
        text_add(note, SKETCH_TEXT_SIZE, "%s%s", separator, chart->lines[i].name);
        separator = ", ";
    }
    if (separator[0] != '\0')
        text_add(note, SKETCH_TEXT_SIZE,
                 ": error against the solution without the velocity that pushes overlapping boxes apart.");
}

static void write_all_counts(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    write_counts(note, chart, "Settings left out, as unstable before the impact: ", offsetof(ChartLine, lost));
    write_counts(note, chart, "Without time or error: ", offsetof(ChartLine, left_out));
    if (chart->floored > 0) text_add(note, SKETCH_TEXT_SIZE, "Errors below %g m/s are drawn there.", PARETO_RESOLUTION);
}

static void write_error(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    (void)chart;
    strcpy(note,
           "Velocity error: difference from the converged solution of the same step, RMS over the boxes; mean over "
           "all launches.");
}

static void write_phases(char note[SKETCH_TEXT_SIZE], const Chart *chart) {
    (void)chart;
    strcpy(note,
           "Impact frames: the first after the bomb touches a box. Pareto front: solvers that no other solver beats "
           "in both time and error.");
}

/* From the bottom; those with nothing to say have no row. */
static void write_notes(ChartLayout *layout) {
    static void (*const writers[CHART_NOTES])(char[SKETCH_TEXT_SIZE], const Chart *) = {
        write_all_counts, write_no_push_out, write_beyond, write_varying, write_times, write_phases, write_error};
    for (int i = 0; i < CHART_NOTES; i++) {
        char *note = layout->notes[layout->foot_rows];
        note[0] = '\0';
        writers[i](note, layout->chart);
        text_fit(note, SKETCH_TEXT_SIZE, WORD_POINTS, CHART_WIDTH - LEFT_MARGIN - 1);
        layout->foot_rows += note[0] != '\0';
    }
}

/* Methods, then what their labels leave out, then keys of settings. */
static void gather_words(WordList *words, const Chart *chart) {
    for (int what = 0; what < 3; what++)
        for (int p = 0; p < CHART_PANELS; p++)
            for (int i = 0; i < chart->panels[p].count; i++) {
                const ChartMark *mark = &chart->panels[p].marks[i];
                const ChartLine *line = &chart->lines[mark->line];
                if (what == 0) words_add_method(words, mark->method);
                if (what == 1 && line->common[0] != '\0') words_add(words, line->name, line->common);
                if (what == 2) words_add_settings(words, mark->method, mark->setting);
            }
}

/* Computes columns and rows of the legend, and the notes below it. */
static void lay_out_legend(ChartLayout *layout) {
    double longest = type_width(front_name, LEGEND_POINTS);
    int entries = 1;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (!is_drawn(line)) continue;
        longest = fmax(longest, type_width(line->name, LEGEND_POINTS));
        entries++;
    }
    const double room = CHART_WIDTH - LEFT_MARGIN;
    layout->columns = (int)(room / (LEGEND_SAMPLE + LEGEND_GAP + longest + 1));
    if (layout->columns < 1) layout->columns = 1;
    layout->rows = (entries + layout->columns - 1) / layout->columns;
    /* The fewest columns for this number of rows: the legend fills its width. */
    layout->columns = (entries + layout->rows - 1) / layout->rows;
    gather_words(&layout->words, layout->chart);
    write_notes(layout);
}

static void draw_legend(const ChartLayout *layout, Sketch *sketch) {
    PlotLook looks[CHART_MAX_LINES + 1];
    int count = 0;
    for (int i = 0; i < layout->chart->line_count; i++) {
        const ChartLine *line = &layout->chart->lines[i];
        if (!is_drawn(line)) continue;
        const bool joined = line->marks[0] > 1 || line->marks[1] > 1;
        looks[count++] = (PlotLook){.name = line->name, .style = line->style, .line = joined ? 1.6 : 0, .marks = true};
    }
    looks[count++] = (PlotLook){.name = front_name, .style = {.colour = PARETO_COLOUR}, .line = 6};
    plot_legend(sketch, looks, count, layout->columns, LEFT_MARGIN, layout->legend_top);
    words_draw(&layout->words, sketch, LEFT_MARGIN, FOOT_ROW * layout->foot_rows + FOOT_GAP);
    for (int i = 0; i < layout->foot_rows; i++)
        plot_text(sketch, (Point){LEFT_MARGIN, FOOT_ROW * (i + 0.5)}, TEXT_LEFT, WORD_POINTS, layout->notes[i]);
}

/* Labels of marks. */

static const double label_height = LABEL_POINTS * MM_PER_POINT * 0.9;

typedef struct Labels {
    const Chart *chart;
    const ChartPanel *panel;
    const PlotPanel *plot;
    LabelField field;
    Sketch *sketch;
} Labels;

/* The corners of the Pareto front: marks on the front by time, each with less error than all faster ones. Returns
   their number and fills order[panel->count] with their indices. */
static int chart_pareto_corners(const ChartPanel *panel, int *order) {
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

/* Draws the labels of a panel's marks: at both ends of each line, where there is room. False if out of memory. */
static bool draw_panel_labels(const ChartLayout *layout, int panel, Sketch *sketch) {
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

/* mm */
static const double gap = 8, top_margin = 5.5, axis_room = 9;

const char *const chart_panel_titles[CHART_PANELS] = {"Impact frames", "The 60 frames after"};

static ChartLayout chart_lay_out(const Chart *chart) {
    ChartLayout layout = {.chart = chart};
    lay_out_legend(&layout);
    layout.legend_top =
        FOOT_ROW * layout.foot_rows + words_height(&layout.words) + 2 * FOOT_GAP + LEGEND_ROW * (layout.rows - 0.5);
    const double below = layout.legend_top + LEGEND_ROW / 2 + axis_room;
    layout.height = fmax(CHART_HEIGHT, below + LEAST_PANEL + top_margin);
    const PlotGrid grid = {.width = CHART_WIDTH,
                           .height = layout.height,
                           .left = LEFT_MARGIN,
                           .right = RIGHT_MARGIN,
                           .bottom = below,
                           .top = top_margin,
                           .columns = CHART_PANELS,
                           .rows = 1,
                           .gap = gap};
    for (int p = 0; p < CHART_PANELS; p++) {
        layout.panels[p] = (PlotPanel){
            .box = plot_grid_box(&grid, p),
            .title = chart_panel_titles[p],
            .x = plot_log_axis(chart->us_least, chart->us_most, "Solver time per step (µs)"),
            .y = plot_log_axis(chart->error_least, chart->error_most, p == 0 ? "Mean velocity error (m/s)" : NULL)};
        plot_panel_place(&layout.panels[p]);
    }
    return layout;
}

void chart_mark_place(const Chart *chart, int panel, const ChartMark *mark, double *left, double *top) {
    const ChartLayout layout = chart_lay_out(chart);
    const Point at = plot_place(&layout.panels[panel], mark->us, mark->error);
    *left = at.x / CHART_WIDTH;
    *top = 1 - at.y / layout.height;
}

double chart_height(const Chart *chart) { return chart_lay_out(chart).height; }

/* The front as a staircase, from the top of the panel to its right edge. */
static bool draw_front(const ChartPanel *panel, const PlotPanel *plot, Sketch *sketch) {
    const PlotLook look = {.style = {.colour = PARETO_COLOUR}, .line = 6};
    int *order = malloc((size_t)panel->count * sizeof *order + 1), count = 0;
    Point *steps = malloc((2 * (size_t)panel->count + 1) * sizeof *steps);
    if (order != NULL && steps != NULL) {
        const int corners = chart_pareto_corners(panel, order);
        for (int i = 0; i < corners; i++) {
            const ChartMark *mark = &panel->marks[order[i]];
            const Point at = plot_place(plot, mark->us, mark->error);
            steps[count] = (Point){at.x, i == 0 ? plot->y.to : steps[count - 1].y};
            steps[count + 1] = at;
            count += 2;
        }
        if (count > 0) steps[count] = (Point){plot->x.to, steps[count - 1].y};
        plot_line(sketch, steps, count > 0 ? count + 1 : 0, &look);
    }
    const bool whole = order != NULL && steps != NULL;
    free(order);
    free(steps);
    return whole;
}

/* The bar of a mark's quartiles; a bar shorter than its mark would only blur it. */
static void draw_quartiles(const ChartMark *mark, const PlotPanel *plot, Sketch *sketch, const PlotLook *look) {
    const Point ends[] = {plot_place(plot, mark->us_q1, mark->error), plot_place(plot, mark->us_q3, mark->error)};
    const Point at = plot_place(plot, mark->us, mark->error);
    if (ends[1].x - at.x > MARK_RADIUS || at.x - ends[0].x > MARK_RADIUS) plot_line(sketch, ends, 2, look);
}

/* Marks of a line follow each other; all lines are below all marks. */
static bool draw_lines(const Chart *chart, const ChartPanel *panel, const PlotPanel *plot, Sketch *sketch) {
    Point *points = malloc((size_t)panel->count * sizeof *points + 1);
    if (points == NULL) return false;
    for (int i = 0; i < panel->count; i++) points[i] = plot_place(plot, panel->marks[i].us, panel->marks[i].error);
    for (int marks = 0; marks <= 1; marks++)
        for (int i = 0, end; i < panel->count; i = end) {
            const PlotStyle style = chart->lines[panel->marks[i].line].style;
            const PlotLook line = {.style = style, .line = 1.6};
            PlotLook bar = line;
            bar.style.dashes = NULL;
            for (end = i; end < panel->count && panel->marks[end].line == panel->marks[i].line;) end++;
            if (marks)
                plot_marks(sketch, points + i, end - i, &style);
            else
                plot_line(sketch, points + i, end - i, &line);
            for (int k = i; !marks && k < end; k++) draw_quartiles(&panel->marks[k], plot, sketch, &bar);
        }
    free(points);
    return true;
}

/* A ring around settings as shipped. */
static void draw_rings(const ChartPanel *panel, const PlotPanel *plot, Sketch *sketch) {
    const PlotStyle ring = {.symbol = METHOD_CIRCLE, .open = true, .colour = 0x000000};
    for (int i = 0; i < panel->count; i++) {
        const ChartMark *mark = &panel->marks[i];
        if (mark->shipped) plot_mark(sketch, plot_place(plot, mark->us, mark->error), &ring, RING_RADIUS, 2.4);
    }
}

/* From bottom to top: front, lines, bars, marks, ring. */
static bool draw_chart(const ChartLayout *layout, const char *title, Sketch *sketch) {
    bool whole = true;
    for (int p = 0; p < CHART_PANELS; p++) {
        const ChartPanel *panel = &layout->chart->panels[p];
        const PlotPanel *plot = &layout->panels[p];
        whole = draw_front(panel, plot, sketch) && draw_lines(layout->chart, panel, plot, sketch) && whole;
        draw_rings(panel, plot, sketch);
        plot_panel_draw(sketch, plot);
        whole = draw_panel_labels(layout, p, sketch) && whole;
    }
    const TextStyle style = {7.5, TEXT_RIGHT, 0x505050, 0, false};
    sketch_text(sketch, (Point){layout->panels[CHART_PANELS - 1].x.to, layout->height - top_margin + 2.5}, &style, "%s",
                title);
    draw_legend(layout, sketch);
    return whole;
}

static bool draw(const Chart *chart, const char *scene, const char *stem, Error *error) {
    char name[CHART_TEXT_SIZE], title[2 * CHART_TEXT_SIZE];
    const ChartLayout layout = chart_lay_out(chart);
    Sketch sketch;
    chart_plain(name, scene);
    snprintf(title, sizeof title, "%s, %d launches", name, chart->launches);
    sketch_begin(&sketch, CHART_WIDTH, layout.height);
    snprintf(sketch.title, sizeof sketch.title, "Speed and accuracy: %s", title);
    const bool drawn = (draw_chart(&layout, title, &sketch) || error_memory(error, stem)) &&
                       sketch_draw(&sketch, stem, SKETCH_PDF, error);
    sketch_free(&sketch);
    return drawn;
}

/* A table from another source must not make us write outside the folder. */
static bool check_name(const char *csv_path, const char *scene, Error *error) {
    return (scene[0] != '\0' && strchr(scene, '/') == NULL) ||
           error_input(error, csv_path, "'%s' is not a valid scene name", scene);
}

bool chart_plot(const char *csv_path, const char *scene, const char *folder, Error *error) {
    char stem[PATH_MAX];
    if (!check_name(csv_path, scene, error)) return false;
    if (!file_path(stem, sizeof stem, error, "%s/chart-%s", folder, scene)) return false;
    CsvTable table;
    if (!csv_table_read(&table, csv_path, &chart_layout, error)) return false;
    Chart chart;
    bool drawn = chart_gather(&chart, &table, scene, csv_path, error);
    if (drawn) {
        drawn = draw(&chart, scene, stem, error);
        chart_free(&chart);
    }
    csv_table_free(&table);
    return drawn;
}
