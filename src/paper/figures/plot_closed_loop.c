/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line per network, one symbol per scene: frames until divergence, and the cost of a step. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"
#include "study/closed_loop.h"

#include <string.h>

enum { LABEL_MAX = 28 };

/* mm */
static const double row_height = 6, left = 36, frames_width = 76, gap = 6, right = 3, bottom = 15, top = 6,
                    legend_top = 2.7;

typedef struct Loop {
    GnuplotPage *page;
    const ClosedLoopRow *rows;
    int count, lines;
    int line[PAPER_MAX_LOOPS]; /* of each row, from the top, from 0 */
    GnuplotAxis frames, cost;
} Loop;

static double ratio(const ClosedLoopRow *row) { return row->us_step / row->us_step_engine; }

/* Networks in the order of their first rows. */
static void number_lines(Loop *loop) {
    for (int i = 0; i < loop->count; i++) {
        int first = 0;
        while (strcmp(loop->rows[first].network, loop->rows[i].network) != 0) first++;
        loop->line[i] = first < i ? loop->line[first] : loop->lines++;
    }
}

/* Scenes are offset, so that equal values do not hide each other. */
static double place(const Loop *loop, int i) {
    return loop->line[i] + 0.23 * (loop->rows[i].scene - (PAPER_SCENES - 1) / 2.0);
}

static GnuplotLook scene_look(int scene) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    return gnuplot_look_marks(gnuplot_look(scene, names[scene]));
}

static void draw_guides(const Loop *loop, const GnuplotAxis *axis, double mark) {
    GnuplotLook guide = {"", {.colour = "#C8C8C8", .ink = "#C8C8C8", .dashes = "solid"}, 0.6, false, 0, false};
    GnuplotLook dashed = gnuplot_look_dashed("");
    gnuplot_series_begin(loop->page);
    for (int line = 0; line + 1 < loop->lines; line++)
        gnuplot_segment(loop->page, axis->log.low, line + 0.5, axis->log.high, line + 0.5);
    gnuplot_series_end(loop->page, &guide);
    gnuplot_series_begin(loop->page);
    gnuplot_segment(loop->page, mark, -0.5, mark, loop->lines - 0.5);
    gnuplot_series_end(loop->page, &dashed);
}

static void draw_panel(Loop *loop, bool costs) {
    const GnuplotAxis *axis = costs ? &loop->cost : &loop->frames;
    GnuplotPage *page = loop->page;
    double width = costs ? FIGURE_PAGE_WIDTH - left - frames_width - gap - right : frames_width;
    gnuplot_panel_begin(page,
                        (GnuplotBox){left + costs * (frames_width + gap), bottom, width, loop->lines * row_height},
                        costs ? "Cost" : "In place of the solver");
    gnuplot_log_axis(page, 'x', axis, costs ? "Step time / the engine's" : "Frames until distance 0.1 m (600: never)");
    gnuplot_linear_axis(page, 'y', loop->lines - 0.5, -0.5, "", NULL);
    draw_guides(loop, axis, costs ? 1 : CLOSED_LOOP_FRAMES);
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        GnuplotLook look = scene_look(scene);
        gnuplot_series_begin(page);
        for (int i = 0; i < loop->count; i++)
            if (loop->rows[i].scene == scene)
                gnuplot_point(
                    page,
                    gnuplot_axis_clamp(page, axis, costs ? ratio(&loop->rows[i]) : loop->rows[i].frames_until_apart),
                    place(loop, i));
        gnuplot_series_end(page, &look);
    }
}

static void draw_names(const Loop *loop) {
    for (int i = 0, next = 0; i < loop->count; i++) {
        if (loop->line[i] != next) continue;
        char text[CSV_NAME_SIZE];
        strcpy(text, loop->rows[i].network);
        gnuplot_truncate(text, LABEL_MAX);
        gnuplot_text(loop->page, left - 1.5, bottom + (loop->lines - next++ - 0.5) * row_height, "right", 7, text);
    }
}

static void draw_legend(const Loop *loop) {
    GnuplotLook looks[PAPER_SCENES];
    int count = 0;
    for (int scene = 0; scene < PAPER_SCENES; scene++) {
        bool used = false;
        for (int i = 0; i < loop->count; i++) used |= loop->rows[i].scene == scene;
        if (used) looks[count++] = scene_look(scene);
    }
    gnuplot_legend(loop->page, looks, count, PAPER_SCENES, left, legend_top);
}

static void choose_axes(Loop *loop) {
    GnuplotRange costs = {1, 1};
    for (int i = 0; i < loop->count; i++) gnuplot_range_include(&costs, ratio(&loop->rows[i]));
    loop->frames = gnuplot_axis((GnuplotRange){1, CLOSED_LOOP_FRAMES}, 1, CLOSED_LOOP_FRAMES, false);
    loop->cost = gnuplot_axis(costs, 1e-3, 1e4, false);
}

bool plot_closed_loop(const char *folder, GnuplotPage *page, Error *error) {
    Loop loop = {.page = page};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_closed_loop_layout, error)) return false;
    loop.rows = table.rows;
    loop.count = table.count;
    number_lines(&loop);
    choose_axes(&loop);
    gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, bottom + loop.lines * row_height + top);
    for (int costs = 0; costs <= 1; costs++) {
        draw_panel(&loop, costs);
        if (costs == 0) draw_names(&loop);
        gnuplot_panel_end(page);
    }
    draw_legend(&loop);
    fprintf(
        page->caption,
        "Networks in place of the solver. Left: frames until a body is 0.1 m from its place in the engine's run (600, "
        "dashed: never). Right: time of a step over that of the engine with its own solver (dashed: equal).");
    gnuplot_page_end(page);
    csv_table_free(&table);
    return true;
}
