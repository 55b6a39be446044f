/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line per network, one symbol per scene: frames until divergence, and the cost of a step. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"
#include "study/closed_loop.h"

#include <math.h>
#include <string.h>

enum { COSTS = 1, PANELS, GUIDES = PAPER_SCENES, DASHED, SERIES };

/* mm */
static const double row_height = 6, left = 36, frames_width = 76, gap = 6, right = 3, bottom = 15, top = 6;

typedef struct Loop {
    const ClosedLoopRow *rows;
    int count, lines;
    int line[PAPER_MAX_LOOPS]; /* of each row, from the top, from 0 */
    PlotTicks none;
} Loop;

static double value_of(const ClosedLoopRow *row, int panel) {
    return panel == COSTS ? row->us_step / row->us_step_engine : row->frames_until_apart;
}

/* Networks in the order of their first rows. */
static void number_lines(Loop *loop) {
    for (int i = 0; i < loop->count; i++) {
        int first = 0;
        while (strcmp(loop->rows[first].network, loop->rows[i].network) != 0) first++;
        loop->line[i] = first < i ? loop->line[first] : loop->lines++;
    }
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    const Loop *loop = of;
    const double width = panel == COSTS ? FIGURE_PAGE_WIDTH - left - frames_width - gap - right : frames_width;
    PlotRange costs = {1, 1};
    for (int i = 0; i < loop->count; i++) plot_range_include(&costs, value_of(&loop->rows[i], COSTS));
    out->box = (PlotBox){left + panel * (frames_width + gap), bottom, width, loop->lines * row_height};
    out->title = panel == COSTS ? "Cost" : "In place of the solver";
    out->x = panel == COSTS ? plot_range_axis(costs, 1e-3, 1e4, false, "Step time / the engine's")
                            : plot_range_axis((PlotRange){1, CLOSED_LOOP_FRAMES}, 1, CLOSED_LOOP_FRAMES, false,
                                              "Frames until divergence by 0.1 m (600: never)");
    out->y = plot_linear_axis(loop->lines - 0.5, -0.5, NULL);
    out->y.ticks = &loop->none;
}

static PlotLook look_of(const void *of, int series) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    (void)of;
    return series == GUIDES   ? plot_look_guide()
           : series == DASHED ? plot_look_dashed(NULL)
                              : plot_look_marks(series, names[series]);
}

/* Scenes are offset, so that equal values do not hide each other. */
static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Loop *loop = of;
    const double end = i % 2 == 0 ? -INFINITY : INFINITY;
    if (series == GUIDES) *out = (PlotPoint){end, i / 2 + 0.5, i / 2};
    if (series == DASHED) *out = (PlotPoint){panel == COSTS ? 1 : CLOSED_LOOP_FRAMES, end, 0};
    if (series >= PAPER_SCENES) return i < 2 * (series == GUIDES ? loop->lines - 1 : 1);
    if (i >= loop->count || loop->rows[i].scene != series) return false;
    *out = (PlotPoint){value_of(&loop->rows[i], panel), loop->line[i] + 0.23 * (series - (PAPER_SCENES - 1) / 2.0), 0};
    return true;
}

static void draw_names(const Loop *loop, Sketch *sketch) {
    for (int i = 0, next = 0; i < loop->count; i++) {
        if (loop->line[i] != next) continue;
        char text[CSV_NAME_SIZE];
        strcpy(text, loop->rows[i].network);
        text_fit(text, sizeof text, 7, left - 3);
        plot_text(sketch, (Point){left - 1.5, bottom + (loop->lines - next++ - 0.5) * row_height}, TEXT_RIGHT, 7, text);
    }
}

bool plot_closed_loop(const char *folder, PlotPage *page, Error *error) {
    static const char caption[] =
        "Networks in place of the solver. Left: frames until a body is 0.1 m from its place in the engine's run (600, "
        "dashed: never). Right: time of a step over that of the engine with its own solver (dashed: equal).";
    Loop loop = {0};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_closed_loop_layout, error)) return false;
    loop.rows = table.rows;
    loop.count = table.count;
    number_lines(&loop);
    const PlotSpec spec = {.of = &loop,
                           .width = FIGURE_PAGE_WIDTH,
                           .height = bottom + loop.lines * row_height + top,
                           .panels = PANELS,
                           .series = SERIES,
                           .rows = 2 * loop.count,
                           .panel = panel_of,
                           .look = look_of,
                           .point = point_of,
                           .legend_columns = PAPER_SCENES,
                           .legend_left = left,
                           .legend_top = 2.7,
                           .caption = caption};
    const bool drawn = plot_draw(page, &spec, folder, error);
    if (drawn) draw_names(&loop, &page->sketch);
    csv_table_free(&table);
    return drawn;
}
