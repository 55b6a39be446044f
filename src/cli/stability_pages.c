/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stability prints, and the pages of its borders and maps. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "cli/larger_commands.h"
#include "cli/page_set.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/player.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "studies/piece_tables.h"
#include "studies/stability.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LABEL_SIZE = 512, VALUE_SIZE = 32, LINE_WIDTH = 79, LABEL_WIDTH = 24 };

/* A number as the tables have it. */
typedef struct Value {
    char text[VALUE_SIZE];
} Value;

static Value stability_pages_show(double number) {
    Value value = {"-"};
    if (!isnan(number)) snprintf(value.text, sizeof value.text, "%.9g", number);
    return value;
}

/* "14 | 15 falls"; without a value on one side: "40 | - moves". */
static void stability_pages_describe(const BorderRow *row, char text[LABEL_SIZE]) {
    const char *verdict = verdict_words[row->verdict];
    if (isnan(row->holds_at) && isnan(row->fails_at))
        snprintf(text, LABEL_SIZE, "%s", verdict);
    else
        snprintf(text, LABEL_SIZE, "%s | %s %s", stability_pages_show(row->holds_at).text,
                 stability_pages_show(row->fails_at).text, verdict);
}

static void write_label(char label[LABEL_SIZE], const char *method, const char *setting) {
    const MethodDescription *description = method_describe(method);
    char whole[LABEL_SIZE];
    snprintf(whole, sizeof whole, "%s%s%s", method, setting[0] != '\0' ? ":" : "", setting);
    if (description != NULL && description->external)
        method_name(label, LABEL_SIZE, whole); /* the setting `name` */
    else
        strcpy(label, whole);
}

/* The borders of one method, from row i on, in as many lines as needed. Returns the row after them. */
static int print_method(const CsvTable *table, int i) {
    const BorderRow *row = border_row(table, i);
    char label[LABEL_SIZE], border[LABEL_SIZE];
    write_label(label, row->method, row->setting);
    int next = i, width = printf("  %-*s", LABEL_WIDTH, label);
    do {
        stability_pages_describe(border_row(table, next), border);
        if (next > i) width += printf(";");
        if (next > i && width + (int)strlen(border) + 2 > LINE_WIDTH) width = printf("\n  %-*s", LABEL_WIDTH, "") - 1;
        width += printf(" %s", border);
        next++;
    } while (next < table->count && border_same_study(border_row(table, next), row) &&
             border_same_method(border_row(table, next), row));
    printf("\n");
    return next;
}

static bool print_borders(const char *folder, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &border_layout, error)) return false;
    for (int i = 0; i < table.count;) {
        const BorderRow *row = border_row(&table, i);
        if (i == 0 || !border_same_study(row, row - 1)) {
            const StabilityStudy *study = stability_study_find(row->study);
            printf("%s: %s%s%s, %s", row->study, row->parameter, row->unit[0] != '\0' ? " in " : "", row->unit,
                   border_is_struck(&table, i) ? "agrees with the reference | differs; reference: stands | falls"
                                               : "holds | fails");
            if (study != NULL && study->rigid != NULL && strcmp(study->parameter, row->parameter) == 0)
                printf(" (rigid boxes: %.4g)", study->rigid());
            printf("\n");
        }
        i = print_method(&table, i);
    }
    csv_table_free(&table);
    return true;
}

static bool same_study(const RunRow *a, const RunRow *b) { return strcmp(a->study, b->study) == 0; }

static bool same_method(const RunRow *a, const RunRow *b) {
    return same_study(a, b) && strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

/* "11 creeps, 0.154 m, -0.217 J": the last value at which the method holds, or else the first. */
static int print_method_at_rest(const RunRow *rows, int count, int i) {
    char label[LABEL_SIZE];
    int next = i, shown = i;
    for (; next < count && same_method(&rows[next], &rows[i]); next++)
        if (rows[next].verdict < VERDICTS && verdict_holds((Verdict)rows[next].verdict)) shown = next;
    const RunRow *row = &rows[shown];
    write_label(label, row->method, row->setting);
    printf("  %-*s %s %s", LABEL_WIDTH, label, stability_pages_show(row->value).text, verdict_words[row->verdict]);
    if (!isnan(row->drift)) printf(", %s m", stability_pages_show(row->drift).text);
    if (!isnan(row->energy)) printf(", %s J", stability_pages_show(row->energy).text);
    printf("\n");
    return next;
}

static bool print_rest(const char *folder, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &rest_layout, error)) return false;
    const RunRow *rows = table.rows;
    for (int i = 0; i < table.count;) {
        if (i == 0 || !same_study(&rows[i], &rows[i - 1]))
            printf("%s: the last %s that holds, drift and energy after %d falls\n", rows[i].study, rows[i].parameter,
                   VERDICT_CREEP_FROM);
        i = print_method_at_rest(rows, table.count, i);
    }
    csv_table_free(&table);
    return true;
}

/* A line a study or map, in the order of the table. */
static bool print_unconverged(const char *folder, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &unconverged_layout, error)) return false;
    printf("steps of the reference that did not converge%s -> %s/unconverged.csv\n", table.count == 0 ? ": none" : "",
           folder);
    for (int i = 0; i < table.count; i++) {
        const char *study = map_cell(&table, i)->map;
        char text[UNCONVERGED_TEXT_SIZE];
        if (i > 0 && strcmp(study, map_cell(&table, i - 1)->map) == 0) continue;
        stability_unconverged(&table, study, text);
        printf("  %-*s %s\n", LABEL_WIDTH, study, text);
    }
    csv_table_free(&table);
    return true;
}

/* If there is such a table. */
static bool print_engines(const char *folder, Error *error) {
    CsvTable table;
    char path[CSV_PATH_SIZE];
    if (!csv_table_path(path, folder, &engine_layout, error)) return false;
    if (access(path, F_OK) != 0) return true;
    if (!csv_table_read_from(&table, folder, &engine_layout, error)) return false;
    for (int i = 0; i < table.count; i++) {
        const EngineRow *row = (const EngineRow *)table.rows + i;
        char label[LABEL_SIZE];
        write_label(label, row->method, row->setting);
        printf("%s: %s is %s %s", row->study, label, row->engine[0] != '\0' ? row->engine : "unknown", row->version);
        if (row->failed > 0) printf("; the adapter failed in %d of %d runs: %s", row->failed, row->runs, row->reason);
        if (!isnan(row->differs))
            printf("; not deterministic: two runs at %s differ", stability_pages_show(row->differs).text);
        printf("\n");
    }
    csv_table_free(&table);
    printf("programs and their failures -> %s\n", path);
    return true;
}

bool stability_print(const char *folder, Error *error) {
    if (!print_borders(folder, error) || !print_rest(folder, error) || !print_engines(folder, error)) return false;
    printf("borders -> %s/stability.csv; maps -> %s/maps.csv\n", folder, folder);
    printf("their figures -> %s/borders.png, %s/map-NAME.png\n", folder, folder);
    printf("why methods do not apply -> %s/refusals.csv\n", folder);
    printf("discarded outputs of networks, steps that fell back -> %s/fallbacks.csv\n", folder);
    printf("drift and energy at rest -> %s/rest.csv\n", folder);
    return print_unconverged(folder, error);
}

/* A file system that many nodes share; its server makes or opens about as many files in a second. */
static const double files_a_second = 1000;

static void print_time(double seconds) {
    if (seconds < 120)
        printf("%7.3g s  ", seconds);
    else if (seconds < 2 * 3600)
        printf("%7.3g min", seconds / 60);
    else
        printf("%7.3g h  ", seconds / 3600);
}

static void print_bytes(double bytes) {
    static const char *const units[] = {"bytes", "KB", "MB", "GB", "TB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 4; unit++) bytes /= 1000;
    printf("%.3g %s", bytes, units[unit]);
}

static void print_cores(const PiecesEstimate *estimate, int cores) {
    double seconds[PIECES_LIMITS];
    const PiecesLimit limit = pieces_times(estimate, cores, files_a_second, seconds);
    printf("%7d  %8" PRId64 "  ", cores, estimate->pieces < cores ? estimate->pieces : cores);
    print_time(fmax(fmax(seconds[LIMIT_COMPUTING], seconds[LIMIT_LONGEST]), seconds[LIMIT_FILES]));
    print_time(seconds[LIMIT_MERGE]);
    printf(" %s\n", pieces_limit_names[limit]);
}

void stability_plan_print(const PiecesEstimate *estimate) {
    static const int cores[] = {1, 10, 1000, 100000};
    char cpu[CPU_NAME_SIZE];
    cpu_name(cpu);
    printf("pieces: %" PRId64 ", of which %d were measured on one core each of %s\n", estimate->pieces,
           estimate->measured, cpu);
    printf("a piece: %.3g s and ", estimate->seconds);
    print_bytes(estimate->bytes);
    printf(" on average, %.3g s at most\n", estimate->longest);
    printf("all: %.4g s on one core; %" PRId64 " files, ", estimate->total, estimate->pieces);
    print_bytes(estimate->bytes * (double)estimate->pieces);
    printf("\n\nif the shared file system makes or opens %.0f files a second:\n", files_a_second);
    printf("  cores    in use    shards       merge     limit\n");
    for (size_t i = 0; i < sizeof cores / sizeof *cores; i++) print_cores(estimate, cores[i]);
}

enum { TITLE_SIZE = 320 };

/* s that are shown before the frame that decided the verdict. */
static const double shown_before = 6;

typedef struct Pages {
    const StabilityPages *options;
    PageSet set;
    CsvTable borders; /* a part each, before those of maps */
    CsvTable table;
    MapPanels *map; /* the current one, */
    int panel;      /* and method */
    int first, row; /* the map's first part; the row of the table behind it */
} Pages;

static bool write_page(Pages *pages, const CellRuns *runs, const MapCell *cell, PageFile *file, Error *error) {
    const Trajectory *const *shown = (const Trajectory *const *)runs->panels.runs;
    char name[MAP_NAME_SIZE], title[TITLE_SIZE];
    map_cell_name(name, cell);
    snprintf(title, sizeof title, "%s %.4g%s%s", cell->x_parameter, cell->x, cell->x_unit[0] != '\0' ? " " : "",
             cell->x_unit);
    if (!isnan(cell->y))
        text_add(title, sizeof title, ", %s %.4g%s%s", cell->y_parameter, cell->y, cell->y_unit[0] != '\0' ? " " : "",
                 cell->y_unit);
    const double first = floor((cell->frame * runs->dt - shown_before) / (double)shown[0]->dt);
    const int last = shown[0]->frames - 1;
    const PlayerOptions options = {.first = first > last ? last
                                            : first > 0  ? (int)first
                                                         : 0,
                                   .last = -1,
                                   .title = title,
                                   .describe = method_describe};
    return page_set_write(&pages->set, name, shown, runs->panels.count, &options, file, error);
}

/* holder: what holds there, or NULL. */
static bool write_cell(Pages *pages, const CellMap *map, const MapCell *holder, const MapCell *cell, FILE *rows,
                       const Progress *progress, Error *error) {
    CellRuns runs;
    PageFile file;
    bool ok = cell_runs_make(&runs, map, holder, cell, cell->map, progress, error) &&
              write_page(pages, &runs, cell, &file, error);
    cell_runs_free(&runs);
    if (!ok) return false;
    const int body = isnan(cell->body) ? -1 : (int)cell->body;
    char link[PAGE_LINK_SIZE];
    page_set_link(link, &file, cell->frame * runs.dt, body, runs.count - 1);
    const MapPage row = {.map = cell->map,
                         .method = cell->method,
                         .setting = cell->setting,
                         .x = cell->x,
                         .y = cell->y,
                         .time = cell->frame * runs.dt,
                         .frame = (int)cell->frame,
                         .body = body,
                         .page = link,
                         .bytes = file.bytes};
    return piece_tables_print(rows, &map_page_layout, -1, &row, error);
}

/* The first method of the row's study with one border, and which holds where the row fails; NULL: none. */
static const BorderRow *find_holder(const CsvTable *borders, const BorderRow *row) {
    for (int i = 0; i < borders->count; i++) {
        const BorderRow *other = border_row(borders, i);
        const bool again =
            (i > 0 && border_same_study(other, other - 1) && border_same_method(other, other - 1)) ||
            (i + 1 < borders->count && border_same_study(other, other + 1) && border_same_method(other, other + 1));
        if (border_same_study(other, row) && !again && border_holds(other, row->fails_at)) return other;
    }
    return NULL;
}

static const StabilityStudy *find_study(const StabilityOptions *options, const BorderRow *row) {
    for (int i = 0; options->own != NULL && i < options->own->study_count; i++)
        if (strcmp(options->own->studies[i].name, row->study) == 0) return &options->own->studies[i];
    return options->own == NULL ? stability_study_find(row->study) : NULL;
}

/* The page of a border's failing side, if it has one. */
static bool write_border(Pages *pages, const BorderRow *row, FILE *rows, const Progress *progress, Error *error) {
    const StabilityOptions *options = pages->options->study;
    const StabilityStudy *study = find_study(options, row);
    const BorderRow *held = find_holder(&pages->borders, row);
    char path[STABILITY_PATH_SIZE];
    MapCell cell, holder;
    if (isnan(row->fails_at) || row->verdict >= VERDICT_ADAPTER_FAILED) return true;
    if (study == NULL) return error_input(error, "--pages", "study %s has no scene", row->study);
    const StabilityPlace place = {options->scenes, study->scene, study->file};
    const CellMap map = {row->study, path, row->parameter, study->fixed.name};
    return stability_path(path, &place, error) &&
           stability_run_cell(study, options->scenes, row, row->fails_at, &cell, error) &&
           (held == NULL || stability_run_cell(study, options->scenes, held, row->fails_at, &holder, error)) &&
           write_cell(pages, &map, held != NULL ? &holder : NULL, &cell, rows, progress, error);
}

/* Behind the borders, parts are the methods of map after map, and come in this order. */
static bool stability_pages_enter(Pages *pages, int part, Error *error) {
    while (part >= pages->first + pages->map->panel_count) {
        pages->first += pages->map->panel_count;
        if (!map_panels_gather(pages->map, &pages->table, &pages->row, error)) return false;
    }
    pages->panel = part - pages->first;
    return true;
}

/* The page of a border, or those of a method in a map. */
static bool write_part(void *context, int part, FILE *rows, const Progress *progress, Error *error) {
    Pages *pages = context;
    const StabilityPages *options = pages->options;
    MapPlace places[MAP_PAGES_EACH];
    if (part < pages->borders.count)
        return write_border(pages, border_row(&pages->borders, part), rows, progress, error);
    if (!stability_pages_enter(pages, part - pages->borders.count, error)) return false;
    const int count = map_pages_choose(pages->map, pages->panel, places);
    for (int i = 0; i < count; i++) {
        const MapCell *cell = map_panels_cell(pages->map, &pages->table, pages->panel, places[i]);
        const CellMap *map = cell_map_find(options->maps, options->map_count, cell->map, error);
        ProgressStage stage = {progress, (double)i / count, 1.0 / count, false};
        if (map == NULL || !write_cell(pages, map, stability_cell_holder(&pages->table, cell), cell, rows,
                                       &(Progress){progress_stage, &stage}, error))
            return false;
    }
    return true;
}

static int count_methods(const CsvTable *table) {
    int count = 0;
    for (int i = 0; i < table->count; i++)
        count += i == 0 || strcmp(map_cell(table, i)->map, map_cell(table, i - 1)->map) != 0 ||
                 !map_cell_same_method(map_cell(table, i), map_cell(table, i - 1));
    return count;
}

bool stability_pages_write(const StabilityPages *options, uint64_t key, Error *error) {
    Pages pages = {
        .options = options,
        .map = calloc(1, sizeof *pages.map),
        .set = {.folder = options->study->folder, .layout = &map_page_layout, .write = write_part, .context = &pages}};
    if (pages.map == NULL) return error_memory(error, "pages");
    bool ok = csv_table_read_from(&pages.table, pages.set.folder, &map_layout, error) &&
              csv_table_read_from(&pages.borders, pages.set.folder, &border_layout, error);
    if (ok) pages.set.parts = pages.borders.count + count_methods(&pages.table);
    ok = ok && page_set_make(&pages.set, key, progress_bar_begin("pages"), error) &&
         stability_html_write(pages.set.folder, error) && page_set_end(&pages.set, error);
    progress_bar_end();
    csv_table_free(&pages.borders);
    csv_table_free(&pages.table);
    free(pages.map);
    if (ok) page_set_print(&pages.set, "stability.html");
    return ok;
}
