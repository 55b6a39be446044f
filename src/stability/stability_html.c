/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_html.h"

#include "common/file.h"
#include "common/house_page.h"
#include "common/html_text.h"
#include "stability/map_pages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A letter for each verdict: colours alone would not do. */
static const char letters[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = 's',     [VERDICT_SWAYS] = 'w',   [VERDICT_CREEPS] = 'c',   [VERDICT_FALLS] = 'F',
    [VERDICT_SINKS] = 'S',       [VERDICT_TUNNELS] = 'T', [VERDICT_EXPLODES] = 'E', [VERDICT_NON_FINITE] = 'N',
    [LOOK_NOT_APPLICABLE] = '-', [LOOK_MISSING] = ' ',
};

typedef struct StabilityHtml {
    MapTable maps;
    CsvTable table; /* of MapPage */
    const MapPage *pages;
    MapPanels *map; /* the current one */
    Error *error;
    bool failed;
} StabilityHtml;

static const MapPage *find_page(const StabilityHtml *html, const MapCell *cell) {
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
    const MapPage *page = cell != NULL ? find_page(html, cell) : NULL;
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
    fputs("<section class=\"panel\" aria-label=\"", out);
    html_put(out, map->first->map);
    fputs("\">\n<h2>", out);
    html_put(out, map->first->map);
    fputs("</h2>\n<p>Across: ", out);
    html_put(out, x);
    fputs("; up: ", out);
    html_put(out, y);
    fputs(".</p>\n<div class=\"maps scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Maps of each method\">\n",
          out);
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

static int count_left_out(const StabilityHtml *html) {
    int count = 0;
    for (int i = 0; i < html->table.count; i++) count += html->pages[i].page[0] == '\0';
    return count;
}

static void put_html(FILE *out, const void *context) {
    StabilityHtml *html = (StabilityHtml *)context; /* where it fails is noted */
    house_page_begin(out, "Stability", stability_css);
    fprintf(
        out,
        "<header><h1>Stability</h1></header>\n"
        "<p class=\"soft\">Each cell is a run and its verdict. Up to %d failing cells of a method beside cells that "
        "hold open a page: it plays the run beside that of the first method that holds there, at the moment and at "
        "the body that decided the verdict.</p>\n",
        MAP_PAGES_EACH);
    const int left_out = count_left_out(html);
    if (left_out > 0) fprintf(out, "<p class=\"odd\">Without a page for lack of room: %d cells.</p>\n", left_out);
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
    if (!file_path(path, sizeof path, error, "%s/stability.html", folder) || !map_table_read(&html.maps, folder, error))
        return false;
    bool done = csv_table_read_from(&html.table, folder, &map_page_layout, error);
    html.pages = html.table.rows;
    html.map = malloc(sizeof *html.map);
    size_t size = 0;
    char *text = done && html.map != NULL ? file_print(put_html, &html, &size) : NULL;
    if (done && text == NULL) done = error_memory(error, path);
    done = done && !html.failed && file_write(path, text, size, error);
    free(text);
    free(html.map);
    csv_table_free(&html.table);
    map_table_free(&html.maps);
    return done;
}
