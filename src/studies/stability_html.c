/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stability.html: borders and maps whose letters link to pages of runs. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "pictures/page.h"
#include "runs/verdict.h"
#include "studies/stability.h"
#include "studies/study_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern const char stability_css[]; /* page/, embedded */

/* A letter for each verdict: colours alone would not do. */
static const char letters[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = 's',  [VERDICT_AGREES] = 'a',     [VERDICT_STANDS] = 'h',         [VERDICT_MOVES] = 'm',
    [VERDICT_CREEPS] = 'c',   [VERDICT_UNDECIDED] = 'u',  [VERDICT_FALLS] = 'F',          [VERDICT_COLLAPSES] = 'C',
    [VERDICT_TOO_FEW] = 'L',  [VERDICT_TOO_MANY] = 'M',   [VERDICT_SINKS] = 'S',          [VERDICT_TUNNELS] = 'T',
    [VERDICT_EXPLODES] = 'E', [VERDICT_NON_FINITE] = 'N', [VERDICT_ADAPTER_FAILED] = 'A', [LOOK_NOT_APPLICABLE] = '-',
    [LOOK_MISSING] = ' ',
};

typedef struct StabilityHtml {
    CsvTable maps, borders;
    CsvTable engines; /* of EngineRow; empty without such a table */
    CsvTable unconverged;
    CsvTable table; /* of MapPage */
    const MapPage *pages;
    MapPanels *map; /* the current one */
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

static void put_link(FILE *out, const MapPage *page, int verdict) {
    html_print(out, "<a href=\"%s\"", page->page);
    fprintf(out, " aria-label=\"%s at %.3g s\">", verdict_words[verdict], page->time);
}

static void put_cell(FILE *out, const StabilityHtml *html, int panel, MapPlace place) {
    const int look = html->map->looks[panel][place.x][place.y];
    const MapCell *cell = map_panels_cell(html->map, &html->maps, panel, place);
    const MapPage *page = cell != NULL ? find_stability_page(html, cell) : NULL;
    const bool linked = page != NULL && page->page[0] != '\0';
    fputs("<td", out);
    put_look(out, look);
    fprintf(out, " title=\"%s\">", verdict_looks[look].name);
    if (linked) put_link(out, page, cell->verdict);
    fputc(letters[look], out);
    fputs(linked ? "</a></td>" : "</td>", out);
}

/* Rows from the highest value down, as in the figure. */
static void put_panel(FILE *out, const StabilityHtml *html, int panel) {
    const MapPanels *map = html->map;
    char method[MAP_METHOD_SIZE];
    map_cell_method(method, map->methods[panel]);
    html_print(out, "<table>\n<caption>%s</caption>\n<thead><tr><td></td>", method);
    for (int x = 0; x < map->x_count; x++) fprintf(out, "<th scope=\"col\">%.3g</th>", map->x[x]);
    fputs("</tr></thead>\n<tbody>\n", out);
    for (int y = map->y_count - 1; y >= 0; y--) {
        fprintf(out, "<tr><th scope=\"row\">%.3g</th>", map->y[y]);
        for (int x = 0; x < map->x_count; x++) put_cell(out, html, panel, (MapPlace){x, y});
        fputs("</tr>\n", out);
    }
    fputs("</tbody>\n</table>\n", out);
}

/* Where the reference did not converge. */
static void put_unconverged(FILE *out, const StabilityHtml *html, const char *study) {
    char text[UNCONVERGED_TEXT_SIZE];
    if (!stability_unconverged(&html->unconverged, study, text)) return;
    html_print(out, "<p>%s: the reference did not converge %s. %s</p>\n", study, text, stability_unconverged_words);
}

static void put_map(FILE *out, const StabilityHtml *html) {
    const MapPanels *map = html->map;
    char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    study_page_section(out, map->first->map);
    html_print(out, "</h2>\n<p>Across: %s; up: %s.</p>\n", x, y);
    put_unconverged(out, html, map->first->map);
    study_page_region(out, "maps scroll", "Maps of each method", "");
    for (int panel = 0; panel < map->panel_count; panel++) put_panel(out, html, panel);
    fputs("</div>\n</section>\n", out);
}

/* Borders: for each study those of all methods, in a grid with as many columns as the window has room for. A table with
   a column for each of a dozen engines would hide most of them. */

static const MapPage *find_border_page(const StabilityHtml *html, const BorderRow *row) {
    for (int i = 0; i < html->table.count; i++) {
        const MapPage *page = &html->pages[i];
        if (page->x == row->fails_at && strcmp(page->map, row->study) == 0 && strcmp(page->method, row->method) == 0 &&
            strcmp(page->setting, row->setting) == 0)
            return page;
    }
    return NULL;
}

static void put_side(FILE *out, double value) { fprintf(out, isnan(value) ? " –" : " %.4g", value); }

static void put_border(FILE *out, const StabilityHtml *html, const BorderRow *row) {
    const MapPage *page = find_border_page(html, row);
    const bool linked = page != NULL && page->page[0] != '\0';
    fputs("<dd><b", out);
    put_look(out, row->verdict);
    fprintf(out, " title=\"%s\">", verdict_looks[row->verdict].name);
    if (linked) put_link(out, page, row->verdict);
    fprintf(out, "%c%s</b>", letters[row->verdict], linked ? "</a>" : "");
    if (!isnan(row->holds_at) || !isnan(row->fails_at)) {
        put_side(out, row->holds_at);
        fputs(" |", out);
        put_side(out, row->fails_at);
    }
    fputs("</dd>", out);
}

/* The row of the table at which method number m begins, by where methods appear first; -1: there are no more. */
static int find_border_method(const CsvTable *borders, int m) {
    for (int i = 0; i < borders->count; i++) {
        bool seen = false;
        for (int k = 0; k < i && !seen; k++) seen = border_same_method(border_row(borders, k), border_row(borders, i));
        if (!seen && m-- == 0) return i;
    }
    return -1;
}

/* The borders of the method of row `at` in the study whose first row is `first`, if it has any. */
static void put_method_borders(FILE *out, const StabilityHtml *html, int first, int at) {
    const CsvTable *borders = &html->borders;
    const BorderRow *study = border_row(borders, first), *of = border_row(borders, at);
    char method[STABILITY_TEXT_SIZE];
    stability_method_name(method, of->method, of->setting);
    bool named = false;
    for (int i = first; i < borders->count && border_same_study(border_row(borders, i), study); i++) {
        if (!border_same_method(border_row(borders, i), of)) continue;
        if (!named) html_print(out, "<div><dt>%s</dt>", method);
        named = true;
        put_border(out, html, border_row(borders, i));
    }
    if (named) fputs("</div>\n", out);
}

/* The study whose first row is `first`. */
static void put_study(FILE *out, const StabilityHtml *html, int first) {
    const BorderRow *study = border_row(&html->borders, first);
    const StabilityStudy *known = stability_study_find(study->study);
    char axis[STABILITY_TEXT_SIZE];
    stability_axis_text(axis, study->parameter, study->unit);
    html_print(out, "<h3>%s <span class=\"soft\">%s</span></h3>\n<dl class=\"borders\">\n",
               known != NULL ? known->title : study->study, axis);
    for (int m = 0, at; (at = find_border_method(&html->borders, m)) >= 0; m++)
        put_method_borders(out, html, first, at);
    fputs("</dl>\n", out);
}

/* What other programs say that they are. */
static void put_engines(FILE *out, const StabilityHtml *html) {
    const EngineRow *rows = html->engines.rows;
    for (int i = 0; i < html->engines.count; i++) {
        char method[STABILITY_TEXT_SIZE];
        bool seen = false;
        for (int k = 0; k < i && !seen; k++)
            seen = strcmp(rows[k].method, rows[i].method) == 0 && strcmp(rows[k].setting, rows[i].setting) == 0;
        if (seen || rows[i].engine[0] == '\0') continue;
        stability_method_name(method, rows[i].method, rows[i].setting);
        html_print(out, "<p class=\"soft\">%s is %s %s.</p>\n", method, rows[i].engine, rows[i].version);
    }
}

static void put_borders(FILE *out, const StabilityHtml *html) {
    const CsvTable *borders = &html->borders;
    if (borders->count == 0) return;
    study_page_section(out, "Borders");
    fputs(
        "</h2>\n<p>The last value that holds | the first that fails, and how it fails there, or how it holds over the "
        "whole range. Between them, a start shifted by a micrometre decides.",
        out);
    bool struck = false;
    for (int i = 0; i < borders->count; i++) struck |= border_is_struck(borders, i);
    if (struck) html_print(out, " %s", stability_struck_words);
    fputs("</p>\n", out);
    for (int i = 0; i < borders->count; i++)
        if (i == 0 || !border_same_study(border_row(borders, i), border_row(borders, i - 1)))
            put_unconverged(out, html, border_row(borders, i)->study);
    for (int i = 0; i < borders->count; i++)
        if (i == 0 || !border_same_study(border_row(borders, i), border_row(borders, i - 1))) put_study(out, html, i);
    put_engines(out, html);
    fputs("</section>\n", out);
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

static bool put_stability(void *context, FILE *out, Error *error) {
    const StabilityHtml *html = context;
    study_page_begin(out, "Stability", stability_css);
    fprintf(
        out,
        "Each letter is the verdict on a run. Where a border fails, and in up to %d failing cells of a method's map "
        "beside cells that hold, it opens a page. The page plays the run beside that of the first method that holds "
        "there, at the moment and at the body that decided the verdict.</p>\n",
        MAP_PAGES_EACH);
    study_page_left_out(out, &html->table, offsetof(MapPage, page), sizeof(MapPage), "cells");
    put_key(out);
    put_borders(out, html);
    for (int row = 0; row < html->maps.count;) {
        if (!map_panels_gather(html->map, &html->maps, &row, error)) return false;
        put_map(out, html);
    }
    house_page_end(out);
    return true;
}

static bool read_engines(StabilityHtml *html, const char *folder, Error *error) {
    char path[CSV_PATH_SIZE];
    if (!csv_table_path(path, folder, &engine_layout, error)) return false;
    return access(path, F_OK) != 0 || csv_table_read(&html->engines, path, &engine_layout, error);
}

bool stability_html_write(const char *folder, Error *error) {
    char path[CSV_PATH_SIZE];
    StabilityHtml html = {0};
    if (!file_path(path, sizeof path, error, "%s/stability.html", folder) ||
        !csv_table_read_from(&html.maps, folder, &map_layout, error))
        return false;
    bool done = csv_table_read_from(&html.borders, folder, &border_layout, error) &&
                csv_table_read_from(&html.unconverged, folder, &unconverged_layout, error) &&
                csv_table_read_from(&html.table, folder, &map_page_layout, error) && read_engines(&html, folder, error);
    html.pages = html.table.rows;
    html.map = malloc(sizeof *html.map);
    if (done && html.map == NULL) done = error_memory(error, path);
    done = done && text_write(path, put_stability, &html, error);
    free(html.map);
    csv_table_free(&html.engines);
    csv_table_free(&html.borders);
    csv_table_free(&html.unconverged);
    csv_table_free(&html.table);
    csv_table_free(&html.maps);
    return done;
}
