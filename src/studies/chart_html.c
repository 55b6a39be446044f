/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of studies: charts and maps whose points and cells link to pages of runs. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "pictures/page.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_internal.h"
#include "studies/stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

extern const char chart_css[], stability_css[]; /* page/, embedded */

static void begin_page(FILE *out, const char *title, const char *style) {
    house_page_begin(out, title, style);
    fprintf(out, "<header><h1>%s</h1></header>\n<p class=\"soft\">", title);
}

/* Begins a part of the page with its heading, without the heading's end. */
static void begin_section(FILE *out, const char *name) {
    fputs("<section class=\"panel\" aria-label=\"", out);
    html_put(out, name);
    fputs("\">\n<h2>", out);
    html_put(out, name);
}

/* A region that can be scrolled, also by the keyboard. */
static void begin_region(FILE *out, const char *style, const char *label, const char *of) {
    fprintf(out, "<div class=\"%s\" tabindex=\"0\" role=\"region\" aria-label=\"%s", style, label);
    html_put(out, of);
    fputs("\">\n", out);
}

/* page: at this place in each row of the table. */
static void put_left_out(FILE *out, const CsvTable *table, size_t page, size_t row_size, const char *what) {
    int count = 0;
    for (int i = 0; i < table->count; i++)
        count += **(const char *const *)((const char *)table->rows + (size_t)i * row_size + page) == '\0';
    if (count > 0) fprintf(out, "<p class=\"odd\">Without a page for lack of room: %d %s.</p>\n", count, what);
}

/* failed: set by `put`, with the error. */
static bool write_page(const char *path, void (*put)(FILE *out, const void *html), const void *html, const bool *failed,
                       Error *error) {
    size_t size = 0;
    char *text = file_print(put, html, &size);
    const bool written = (text != NULL || error_memory(error, path)) && !*failed && file_write(path, text, size, error);
    free(text);
    return written;
}

/* stability.html */

/* A letter for each verdict: colours alone would not do. */
static const char letters[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = 's',        [VERDICT_SWAYS] = 'w',       [VERDICT_CREEPS] = 'c',   [VERDICT_FALLS] = 'F',
    [VERDICT_SINKS] = 'S',          [VERDICT_TUNNELS] = 'T',     [VERDICT_EXPLODES] = 'E', [VERDICT_NON_FINITE] = 'N',
    [VERDICT_ADAPTER_FAILED] = 'A', [LOOK_NOT_APPLICABLE] = '-', [LOOK_MISSING] = ' ',
};

typedef struct StabilityHtml {
    CsvTable maps;
    CsvTable table; /* of MapPage */
    const MapPage *pages;
    MapPanels *map; /* the current one */
    Error *error;
    bool failed;
} StabilityHtml;

static const MapPage *find_stability_page(const StabilityHtml *html, const MapCell *cell) {
    for (int i = 0; i < html->table.count; i++) {
        const MapPage *page = &html->pages[i];
        if (page->x == cell->x && page->y == cell->y && strcmp(page->map, cell->map) == 0 &&
            strcmp(page->method, cell->method) == 0 && strcmp(page->setting, cell->setting) == 0)
            return page;
    }
    return NULL;
}

/* The colour of a cell, and the class of those with light letters or without a colour. */
static void put_look(FILE *out, int look) {
    if (verdict_looks[look].fill == NO_COLOUR) {
        fputs(" class=\"empty\"", out);
        return;
    }
    if (look >= VERDICT_TUNNELS) fputs(" class=\"light\"", out);
    fprintf(out, " style=\"background:#%06X\"", verdict_looks[look].fill);
}

static void put_link(FILE *out, const MapPage *page, const MapCell *cell) {
    fputs("<a href=\"", out);
    html_put(out, page->page);
    fprintf(out, "\" aria-label=\"%s at %.3g s\">", verdict_words[cell->verdict], page->time);
}

static void put_cell(FILE *out, const StabilityHtml *html, int panel, MapPlace place) {
    const int look = html->map->looks[panel][place.x][place.y];
    const MapCell *cell = map_panels_cell(html->map, &html->maps, panel, place);
    const MapPage *page = cell != NULL ? find_stability_page(html, cell) : NULL;
    const bool linked = page != NULL && page->page[0] != '\0';
    fputs("<td", out);
    put_look(out, look);
    fprintf(out, " title=\"%s\">", verdict_looks[look].name);
    if (linked) put_link(out, page, cell);
    fputc(letters[look], out);
    fputs(linked ? "</a></td>" : "</td>", out);
}

/* Rows from the highest value down, as in the figure. */
static void put_panel(FILE *out, const StabilityHtml *html, int panel) {
    const MapPanels *map = html->map;
    char method[MAP_METHOD_SIZE];
    map_cell_method(method, map->methods[panel]);
    fputs("<table>\n<caption>", out);
    html_put(out, method);
    fputs("</caption>\n<thead><tr><td></td>", out);
    for (int x = 0; x < map->x_count; x++) fprintf(out, "<th scope=\"col\">%.3g</th>", map->x[x]);
    fputs("</tr></thead>\n<tbody>\n", out);
    for (int y = map->y_count - 1; y >= 0; y--) {
        fprintf(out, "<tr><th scope=\"row\">%.3g</th>", map->y[y]);
        for (int x = 0; x < map->x_count; x++) put_cell(out, html, panel, (MapPlace){x, y});
        fputs("</tr>\n", out);
    }
    fputs("</tbody>\n</table>\n", out);
}

static void put_map(FILE *out, const StabilityHtml *html) {
    const MapPanels *map = html->map;
    char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    begin_section(out, map->first->map);
    fputs("</h2>\n<p>Across: ", out);
    html_put(out, x);
    fputs("; up: ", out);
    html_put(out, y);
    fputs(".</p>\n", out);
    begin_region(out, "maps scroll", "Maps of each method", "");
    for (int panel = 0; panel < map->panel_count; panel++) put_panel(out, html, panel);
    fputs("</div>\n</section>\n", out);
}

static void put_key(FILE *out) {
    fputs("<ul class=\"key\" aria-label=\"Verdicts\">\n", out);
    for (int look = 0; look < LOOK_MISSING; look++) {
        fputs("<li><b", out);
        put_look(out, look);
        fprintf(out, ">%c</b> %s</li>\n", letters[look], verdict_looks[look].name);
    }
    fputs("<li><b class=\"page\">F</b> with a frame: opens a page</li>\n</ul>\n", out);
}

static void put_stability(FILE *out, const void *context) {
    StabilityHtml *html = (StabilityHtml *)context; /* where it fails is noted */
    begin_page(out, "Stability", stability_css);
    fprintf(out,
            "Each cell is a run and its verdict. Up to %d failing cells of a method beside cells that hold open a "
            "page: it plays the run beside that of the first method that holds there, at the moment and at the body "
            "that decided the verdict.</p>\n",
            MAP_PAGES_EACH);
    put_left_out(out, &html->table, offsetof(MapPage, page), sizeof(MapPage), "cells");
    put_key(out);
    for (int row = 0; row < html->maps.count && !html->failed;) {
        html->failed = !map_panels_gather(html->map, &html->maps, &row, html->error);
        if (!html->failed) put_map(out, html);
    }
    house_page_end(out);
}

bool stability_html_write(const char *folder, Error *error) {
    char path[CSV_PATH_SIZE];
    StabilityHtml html = {.error = error};
    if (!file_path(path, sizeof path, error, "%s/stability.html", folder) ||
        !csv_table_read_from(&html.maps, folder, &map_layout, error))
        return false;
    bool done = csv_table_read_from(&html.table, folder, &map_page_layout, error);
    html.pages = html.table.rows;
    html.map = malloc(sizeof *html.map);
    if (done && html.map == NULL) done = error_memory(error, path);
    done = done && write_page(path, put_stability, &html, &html.failed, error);
    free(html.map);
    csv_table_free(&html.table);
    csv_table_free(&html.maps);
    return done;
}

/* chart.html */

typedef struct ChartHtml {
    CsvTable chart;
    CsvTable table; /* of LaunchPage */
    const LaunchPage *pages;
    const char *csv; /* path of the chart's table */
    Error *error;
    bool failed;
} ChartHtml;

static bool same_point(const LaunchPage *page, const char *scene, const char *method, const char *setting,
                       Phase phase) {
    return page->phase == phase && strcmp(page->scene, scene) == 0 && strcmp(page->method, method) == 0 &&
           strcmp(page->setting, setting) == 0;
}

static const LaunchPage *find_page(const ChartHtml *html, const char *scene, const char *method, const char *setting,
                                   Phase phase) {
    for (int i = 0; i < html->table.count; i++)
        if (same_point(&html->pages[i], scene, method, setting, phase)) return &html->pages[i];
    return NULL;
}

static const ChartRow *find_row(const ChartHtml *html, const LaunchPage *page) {
    for (int i = 0; i < html->chart.count; i++) {
        const ChartRow *row = chart_row(&html->chart, i);
        if (row->protocol == PROTOCOL_CLOSED && same_point(page, row->scene, row->method, row->setting, row->phase))
            return row;
    }
    return NULL;
}

/* The table is the way for the keyboard and for screen readers. */
static void put_point(FILE *out, const Chart *chart, int panel, const ChartMark *mark, const LaunchPage *page) {
    double left, top;
    if (page == NULL || page->page[0] == '\0') return;
    chart_mark_place(chart, panel, mark, &left, &top);
    fprintf(out, "<a class=\"point\" tabindex=\"-1\" aria-hidden=\"true\" style=\"left:%.3f%%;top:%.3f%%\" href=\"",
            100 * left, 100 * top);
    html_put(out, page->page);
    fputs("\" title=\"", out);
    html_put(out, mark->method);
    fputs(mark->setting[0] != '\0' ? ":" : "", out);
    html_put(out, mark->setting);
    fprintf(out, ": %.3g µs, %.3g m/s\"></a>\n", mark->us, mark->error);
}

static void put_figure(FILE *out, const ChartHtml *html, const Chart *chart, const char *scene) {
    begin_region(out, "scroll", "Chart of ", scene);
    fputs("<figure>\n<img src=\"chart-", out);
    html_put_address(out, scene);
    fprintf(out, ".svg\" width=\"%.0f\" height=\"%.0f\" alt=\"Velocity error over solver time for each method in ",
            10 * CHART_WIDTH, 10 * chart_height(chart));
    html_put(out, scene);
    fputs("; the table below has the points.\">\n", out);
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            put_point(out, chart, p, mark, find_page(html, scene, mark->method, mark->setting, (Phase)p));
        }
    fputs("</figure>\n</div>\n", out);
}

static void put_number(FILE *out, double number) {
    fputs("<td class=\"number\">", out);
    if (!isnan(number)) fprintf(out, "%.3g", number);
    fputs("</td>", out);
}

/* Time and error of the point, and its worst launch. */
static void put_phase(FILE *out, const ChartHtml *html, const LaunchPage *page) {
    if (page == NULL) {
        fputs("<td></td><td></td><td></td>", out);
        return;
    }
    const ChartRow *row = find_row(html, page);
    const bool linked = page->page[0] != '\0';
    put_number(out, row != NULL ? row->us_solver : (double)NAN);
    put_number(out, row != NULL ? row->error_mean : (double)NAN);
    fputs("<td>", out);
    if (linked) {
        fputs("<a href=\"", out);
        html_put(out, page->page);
        fputs("\">", out);
    }
    fprintf(out, "x = %.3g m: %.3g m/s at %.3g s", (double)page->x, page->error, page->time);
    if (page->body >= 0) fprintf(out, ", body %d", page->body);
    fputs(linked ? "</a></td>" : "</td>", out);
}

static void put_method(FILE *out, const ChartHtml *html, const LaunchPage *page) {
    fputs("<tr><th scope=\"row\">", out);
    html_put(out, page->method);
    fputs("</th><td>", out);
    html_put(out, page->setting);
    fputs("</td>", out);
    for (int p = 0; p < CHART_PANELS; p++)
        put_phase(out, html, find_page(html, page->scene, page->method, page->setting, (Phase)p));
    fputs("</tr>\n", out);
}

/* A row for each method and setting. Rows of both phases follow each other. */
static void put_table(FILE *out, const ChartHtml *html, const char *scene) {
    begin_region(out, "scroll", "Points of ", scene);
    fputs("<table>\n<thead><tr><th rowspan=\"2\" scope=\"col\">Method</th>"
          "<th rowspan=\"2\" scope=\"col\">Setting</th>",
          out);
    for (int p = 0; p < CHART_PANELS; p++)
        fprintf(out, "<th colspan=\"3\" scope=\"colgroup\">%s</th>", chart_panel_titles[p]);
    fputs("</tr>\n<tr>", out);
    for (int p = 0; p < CHART_PANELS; p++)
        fputs("<th class=\"number\" scope=\"col\">Time, µs</th><th class=\"number\" scope=\"col\">Error, m/s</th>"
              "<th scope=\"col\">Worst launch</th>",
              out);
    fputs("</tr></thead>\n<tbody>\n", out);
    for (int i = 0; i < html->table.count; i++) {
        const LaunchPage *page = &html->pages[i], *before = page - 1;
        if (strcmp(page->scene, scene) != 0) continue;
        if (i > 0 && strcmp(before->scene, scene) == 0 && strcmp(before->method, page->method) == 0 &&
            strcmp(before->setting, page->setting) == 0)
            continue;
        put_method(out, html, page);
    }
    fputs("</tbody>\n</table>\n</div>\n", out);
}

static void put_scene(FILE *out, ChartHtml *html, const ChartRow *first) {
    Chart chart;
    if (chart_scene_untimed(html->chart.rows, html->chart.count, first->scene)) {
        begin_section(out, first->scene);
        fprintf(out, ", %d launches</h2>\n", first->launches);
        fputs("<p>Without a chart: its times were measured on another processor.</p>\n", out);
    } else if (chart_gather(&chart, &html->chart, first->scene, html->csv, html->error)) {
        begin_section(out, first->scene);
        fprintf(out, ", %d launches</h2>\n", chart.launches);
        put_figure(out, html, &chart, first->scene);
        chart_free(&chart);
    } else {
        html->failed = true;
        return;
    }
    put_table(out, html, first->scene);
    fputs("</section>\n", out);
}

static bool is_first(const ChartHtml *html, int row) {
    int first = 0;
    while (strcmp(chart_row(&html->chart, first)->scene, chart_row(&html->chart, row)->scene) != 0) first++;
    return first == row;
}

static void put_chart(FILE *out, const void *context) {
    ChartHtml *html = (ChartHtml *)context; /* where it fails is noted */
    char times[CHART_TIMES_SIZE];
    begin_page(out, "Speed and accuracy", chart_css);
    fputs("Each point opens a page that plays the launch that was worst for it, beside the converged run, at the step "
          "with the largest error. Errors are means over all launches, of velocities against the converged solution of "
          "the same step; of a step, over its bodies.</p>\n",
          out);
    chart_times_note(times, html->chart.rows, html->chart.count);
    if (times[0] != '\0') {
        fputs("<p class=\"soft\">", out);
        html_put(out, times);
        fputs("</p>\n", out);
    }
    put_left_out(out, &html->table, offsetof(LaunchPage, page), sizeof(LaunchPage), "points");
    for (int i = 0; i < html->chart.count; i++)
        if (!html->failed && is_first(html, i)) put_scene(out, html, chart_row(&html->chart, i));
    house_page_end(out);
}

bool chart_html_write(const char *folder, Error *error) {
    char csv[CSV_PATH_SIZE], path[CSV_PATH_SIZE];
    ChartHtml html = {.csv = csv, .error = error};
    if (!csv_table_path(csv, folder, &chart_layout, error) ||
        !file_path(path, sizeof path, error, "%s/chart.html", folder) ||
        !csv_table_read(&html.chart, csv, &chart_layout, error))
        return false;
    bool done = csv_table_read_from(&html.table, folder, &launch_page_layout, error);
    html.pages = html.table.rows;
    done = done && write_page(path, put_chart, &html, &html.failed, error);
    csv_table_free(&html.table);
    csv_table_free(&html.chart);
    return done;
}
