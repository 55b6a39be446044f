/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stability.html: the borders and maps as tables whose verdicts link to what happens there. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "pictures/page.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"
#include "studies/study_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char style[] =
    ".maps { display: flex; flex-wrap: wrap; gap: 1rem 2rem; }\n"
    ".maps td, .maps th { padding: 1px 3px; font-size: 11px; text-align: center; }\n"
    ".maps td { color: #140a1c; } .maps .light, .maps .light a { color: #fff; } .maps a { color: inherit; }\n"
    "caption { text-align: left; font-weight: 700; }\n";

typedef struct Html {
    CsvTable borders, maps;
    MapPanels *map; /* the current one */
    const StudyPlace *places;
} Html;

/* The tables have no other studies. */
static const StudyPlace *find_place(const StudyPlace *place, const char *name) {
    while (strcmp(place->name, name) != 0) place++;
    return place;
}

static void put_value(FILE *out, double value) {
    if (isnan(value))
        fputs("<td>–</td>", out);
    else
        fprintf(out, "<td>%.4g</td>", value);
}

static void put_borders(FILE *out, const Html *html) {
    for (int i = 0; i < html->borders.count; i++) {
        const BorderRow *row = border_row(&html->borders, i);
        const StudyPlace *place = find_place(html->places, row->study);
        char set[2 * SCENE_PARAMETER_SIZE + 64], axis[STABILITY_TEXT_SIZE], method[STABILITY_TEXT_SIZE];
        if (i == 0 || !border_same_study(row, row - 1)) {
            if (i > 0) fputs("</table>\n", out);
            stability_axis_text(axis, row->parameter, row->unit);
            html_print(out, "<h3>%s</h3>\n<table>\n<tr><th>%s</th><th>holds at</th><th>fails at</th><th></th></tr>\n",
                       place->name, axis);
        }
        stability_method_name(method, row->method, row->setting);
        html_print(out, "<tr><td>%s</td>", method);
        put_value(out, row->holds_at);
        put_value(out, row->fails_at);
        snprintf(set, sizeof set, "%s=%.9g", row->parameter, isnan(row->fails_at) ? row->holds_at : row->fails_at);
        if (place->fixed != NULL && place->fixed->name[0] != '\0')
            text_add(set, sizeof set, ",%s=%.9g", place->fixed->name, place->fixed->value);
        fputs("<td>", out);
        if (isnan(row->holds_at) && isnan(row->fails_at))
            fputs(verdict_looks[row->verdict].name, out);
        else
            study_link_put(out, &place->page, set, row->method, row->setting, verdict_looks[row->verdict].name);
        fputs("</td></tr>\n", out);
    }
    if (html->borders.count > 0) fputs("</table>\n", out);
}

static void put_panel(FILE *out, const Html *html, const StudyPlace *place, int panel) {
    const MapPanels *map = html->map;
    const MapCell *of = map->methods[panel];
    char method[STABILITY_TEXT_SIZE];
    stability_method_name(method, of->method, of->setting);
    html_print(out, "<table>\n<caption>%s</caption>\n<tr><th></th>", method);
    for (int x = 0; x < map->x_count; x++) fprintf(out, "<th>%.3g</th>", map->x[x]);
    fputs("</tr>\n", out);
    for (int y = map->y_count - 1; y >= 0; y--) { /* from the highest value down, as in the figure */
        fprintf(out, "<tr><th>%.3g</th>", map->y[y]);
        for (int x = 0; x < map->x_count; x++) {
            const int look = map->looks[panel][x][y];
            const VerdictLook *drawn = &verdict_looks[look];
            char set[2 * SCENE_PARAMETER_SIZE + 64], word[4];
            snprintf(set, sizeof set, "%s=%.9g,%s=%.9g", of->x_parameter, map->x[x], of->y_parameter, map->y[y]);
            snprintf(word, sizeof word, "%s", drawn->name);
            fprintf(out, "<td title=\"%s\"", drawn->name);
            if (look >= VERDICT_TUNNELS && look < VERDICTS) fputs(" class=\"light\"", out);
            if (drawn->fill != NO_COLOUR) fprintf(out, " style=\"background:#%06X\"", drawn->fill);
            fputc('>', out);
            if (look < VERDICTS) study_link_put(out, &place->page, set, of->method, of->setting, word);
            fputs("</td>", out);
        }
        fputs("</tr>\n", out);
    }
    fputs("</table>\n", out);
}

static bool put_all(void *context, FILE *out, Error *error) {
    const Html *html = context;
    house_page_begin(out, "Stability", style);
    fputs("<h1>Stability</h1>\n<p class=\"soft\">How each method holds or fails. A verdict opens the scene with the "
          "values of its place, stepped in the browser by the method with the same bits, beside interior. Of a border "
          "that is the first value that fails, or the last that holds where none does; without the shifts of a "
          "micrometre that borders are tried with.</p>\n",
          out);
    put_borders(out, html);
    for (int row = 0; row < html->maps.count;) {
        char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
        if (!map_panels_gather(html->map, &html->maps, &row, error)) return false;
        const MapCell *first = html->map->first;
        const StudyPlace *place = find_place(html->places, first->map);
        stability_axis_text(x, first->x_parameter, first->x_unit);
        stability_axis_text(y, first->y_parameter, first->y_unit);
        html_print(out, "<h3>%s</h3>\n<p>Across: %s; up: %s.</p>\n<div class=\"maps\">\n", first->map, x, y);
        for (int panel = 0; panel < html->map->panel_count; panel++) put_panel(out, html, place, panel);
        fputs("</div>\n", out);
    }
    house_page_end(out);
    return true;
}

bool stability_html_write(const char *folder, const StudyPlace *places, Error *error) {
    char path[CSV_PATH_SIZE];
    Html html = {.places = places, .map = malloc(sizeof *html.map)};
    bool ok = html.map != NULL || error_memory(error, folder);
    ok = ok && file_path(path, sizeof path, error, "%s/stability.html", folder) &&
         csv_table_read_from(&html.borders, folder, &border_layout, error) &&
         csv_table_read_from(&html.maps, folder, &map_layout, error) && text_write(path, put_all, &html, error);
    csv_table_free(&html.maps);
    csv_table_free(&html.borders);
    free(html.map);
    return ok;
}
