/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.html: charts whose points link to pages of runs; and what it has in common with stability.html. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "pictures/page.h"
#include "scenes/scenes.h"
#include "studies/chart_data.h"
#include "studies/chart_drawing.h"
#include "studies/chart_pages.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/study_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

extern const char chart_css[]; /* page/, embedded */

void study_page_begin(FILE *out, const char *title, const char *style) {
    house_page_begin(out, title, style);
    fprintf(out, "<header><h1>%s</h1></header>\n<p class=\"soft\">", title);
}

void study_page_section(FILE *out, const char *name) {
    html_print(out, "<section class=\"panel\" aria-label=\"%s\">\n<h2>%s", name, name);
}

void study_page_region(FILE *out, const char *style, const char *label, const char *of) {
    html_print(out, "<div class=\"%s\" tabindex=\"0\" role=\"region\" aria-label=\"%s%s\">\n", style, label, of);
}

void study_page_left_out(FILE *out, const CsvTable *table, size_t page, size_t row_size, const char *what) {
    int count = 0;
    for (int i = 0; i < table->count; i++)
        count += **(const char *const *)((const char *)table->rows + (size_t)i * row_size + page) == '\0';
    if (count > 0) fprintf(out, "<p class=\"odd\">Without a page for lack of room: %d %s.</p>\n", count, what);
}

typedef struct Text {
    TextWrite *write;
    void *context;
    bool whole;
    Error *error;
} Text;

static void print_text(FILE *out, const void *context) {
    Text *text = (Text *)context;
    text->whole = text->write(text->context, out, text->error);
}

char *text_print(TextWrite *write, void *context, size_t *size, const char *what, Error *error) {
    Text printed = {write, context, true, error};
    char *text = file_print(print_text, &printed, size);
    if (text != NULL && printed.whole) return text;
    if (printed.whole) error_memory(error, what);
    free(text);
    return NULL;
}

bool text_write(const char *path, TextWrite *write, void *context, Error *error) {
    size_t size;
    char *text = text_print(write, context, &size, path, error);
    const bool written = text != NULL && file_write(path, text, size, error);
    free(text);
    return written;
}

/* chart.html */

typedef struct ChartHtml {
    CsvTable chart;
    CsvTable table; /* of LaunchPage */
    const LaunchPage *pages;
    const char *csv; /* path of the chart's table */
    const ChartLook *look;
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
static void put_point(FILE *out, const ChartPicture *picture, int panel, const ChartMark *mark,
                      const LaunchPage *page) {
    double left, top;
    if (page == NULL || page->page[0] == '\0') return;
    chart_mark_place(picture, panel, mark, &left, &top);
    fprintf(out, "<a class=\"point\" tabindex=\"-1\" aria-hidden=\"true\" style=\"left:%.3f%%;top:%.3f%%\" href=\"",
            100 * left, 100 * top);
    html_print(out, "%s\" title=\"%s%s%s", page->page, mark->method, mark->setting[0] != '\0' ? ":" : "",
               mark->setting);
    fprintf(out, ": %.3g µs, %.3g m/s\"></a>\n", mark->us, mark->error);
}

static void put_figure(FILE *out, const ChartHtml *html, const ChartPicture *picture, const char *scene) {
    const Chart *chart = picture->chart;
    study_page_region(out, "scroll", "Chart of ", scene);
    fputs("<figure>\n<img src=\"chart-", out);
    html_put_address(out, scene);
    fprintf(out, ".svg\" width=\"%.0f\" height=\"%.0f\" alt=\"Velocity error over solver time for each method in ",
            10 * picture->width, 10 * picture->height);
    html_put(out, scene);
    fputs("; the table below has the points.\">\n", out);
    for (int p = 0; p < CHART_PANELS; p++)
        for (int i = 0; i < chart->panels[p].count; i++) {
            const ChartMark *mark = &chart->panels[p].marks[i];
            put_point(out, picture, p, mark, find_page(html, scene, mark->method, mark->setting, (Phase)p));
        }
    fputs("</figure>\n</div>\n", out);
}

static void put_number(FILE *out, double number, const char *after) {
    fputs("<td class=\"number\">", out);
    if (!isnan(number)) fprintf(out, "%.3g%s", number, after);
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
    put_number(out, row != NULL ? row->us_solver : (double)NAN, row != NULL && row->us_varies > 0 ? " varies" : "");
    put_number(out, row != NULL ? row->error_mean : (double)NAN, "");
    fputs("<td>", out);
    if (linked) html_print(out, "<a href=\"%s\">", page->page);
    fprintf(out, "x = %.3g m: %.3g m/s at %.3g s", (double)page->x, page->error, page->time);
    if (page->body >= 0) fprintf(out, ", body %d", page->body);
    fputs(linked ? "</a></td>" : "</td>", out);
}

static void put_method(FILE *out, const ChartHtml *html, const LaunchPage *page) {
    html_print(out, "<tr><th scope=\"row\">%s</th><td>%s</td>", page->method, page->setting);
    for (int p = 0; p < CHART_PANELS; p++)
        put_phase(out, html, find_page(html, page->scene, page->method, page->setting, (Phase)p));
    fputs("</tr>\n", out);
}

/* A row for each method and setting. Rows of both phases follow each other. */
static void put_table(FILE *out, const ChartHtml *html, const char *scene) {
    study_page_region(out, "scroll", "Points of ", scene);
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

static bool put_drawn(FILE *out, const ChartHtml *html, const Chart *chart, const char *scene, Error *error) {
    ChartPicture picture;
    if (!chart_picture_make(&picture, chart, scene, html->look, error)) return false;
    study_page_section(out, scene);
    fprintf(out, ", %d launch%s</h2>\n", chart->launches, plural_es(chart->launches));
    put_figure(out, html, &picture, scene);
    chart_picture_free(&picture);
    return true;
}

static bool put_scene(FILE *out, const ChartHtml *html, const ChartRow *first, Error *error) {
    Chart chart;
    if (chart_scene_untimed(html->chart.rows, html->chart.count, first->scene)) {
        study_page_section(out, first->scene);
        fprintf(out, ", %d launch%s</h2>\n", first->launches, plural_es(first->launches));
        fputs("<p>Without a chart: its times were measured on another processor.</p>\n", out);
    } else {
        if (!chart_gather(&chart, &html->chart, first->scene, html->csv, html->look->highlight, error)) return false;
        const bool drawn =
            chart_colour(&chart, &html->look->colours, error) && put_drawn(out, html, &chart, first->scene, error);
        chart_free(&chart);
        if (!drawn) return false;
    }
    put_table(out, html, first->scene);
    fputs("</section>\n", out);
    return true;
}

static bool is_first(const ChartHtml *html, int row) {
    int first = 0;
    while (strcmp(chart_row(&html->chart, first)->scene, chart_row(&html->chart, row)->scene) != 0) first++;
    return first == row;
}

static bool put_chart(void *context, FILE *out, Error *error) {
    const ChartHtml *html = context;
    char times[CHART_TIMES_SIZE];
    study_page_begin(out, "Speed and accuracy", chart_css);
    fputs("Each point opens a page that plays the launch that was worst for it, beside the converged run, at the step "
          "with the largest error. Errors are means over all launches, of velocities against the converged solution of "
          "the same step; of a step, over its bodies.</p>\n",
          out);
    chart_times_note(times, html->chart.rows, html->chart.count);
    if (times[0] != '\0') html_print(out, "<p class=\"soft\">%s</p>\n", times);
    study_page_left_out(out, &html->table, offsetof(LaunchPage, page), sizeof(LaunchPage), "points");
    for (int i = 0; i < html->chart.count; i++)
        if (is_first(html, i) && !put_scene(out, html, chart_row(&html->chart, i), error)) return false;
    house_page_end(out);
    return true;
}

bool chart_html_write(const char *folder, const ChartLook *look, Error *error) {
    char csv[CSV_PATH_SIZE], path[CSV_PATH_SIZE];
    ChartHtml html = {.csv = csv, .look = look};
    if (!csv_table_path(csv, folder, &chart_layout, error) ||
        !file_path(path, sizeof path, error, "%s/chart.html", folder) ||
        !csv_table_read(&html.chart, csv, &chart_layout, error))
        return false;
    bool done = csv_table_read_from(&html.table, folder, &launch_page_layout, error);
    html.pages = html.table.rows;
    done = done && text_write(path, put_chart, &html, error);
    csv_table_free(&html.table);
    csv_table_free(&html.chart);
    return done;
}
