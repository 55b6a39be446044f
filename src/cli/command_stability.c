/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox stability: the command, and its tables for the terminal. */
#include "base/base.h"
#include "base/csv.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "runs/pieces.h"
#include "runs/verdict.h"
#include "studies/contenders.h"
#include "studies/stability.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { LABEL_SIZE = 512, VALUE_SIZE = 32, LINE_WIDTH = 79, LABEL_WIDTH = 24 };

/* A number as the tables have it. */
typedef struct Value {
    char text[VALUE_SIZE];
} Value;

static Value show(double number) {
    Value value = {"-"};
    if (!isnan(number)) snprintf(value.text, sizeof value.text, "%.9g", number);
    return value;
}

/* "14 | 15 falls"; without a value on one side: "40 | - moves". */
static void describe(const BorderRow *row, char text[LABEL_SIZE]) {
    const char *verdict = verdict_words[row->verdict];
    if (isnan(row->holds_at) && isnan(row->fails_at))
        snprintf(text, LABEL_SIZE, "%s", verdict);
    else
        snprintf(text, LABEL_SIZE, "%s | %s %s", show(row->holds_at).text, show(row->fails_at).text, verdict);
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
        describe(border_row(table, next), border);
        if (next > i) width += printf(";");
        if (next > i && width + (int)strlen(border) + 2 > LINE_WIDTH) width = printf("\n  %-*s", LABEL_WIDTH, "") - 1;
        width += printf(" %s", border);
        next++;
    } while (next < table->count && border_same_study(border_row(table, next), row) &&
             border_same_method(border_row(table, next), row));
    printf("\n");
    return next;
}

static bool print_borders(const char *folder, const StabilityOwn *own, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &border_layout, error)) return false;
    for (int i = 0; i < table.count;) {
        const BorderRow *row = border_row(&table, i);
        if (i == 0 || !border_same_study(row, row - 1)) {
            const StabilityStudy *study = stability_study_find(row->study);
            printf("%s: %s%s%s, %s", row->study, row->parameter, row->unit[0] != '\0' ? " in " : "", row->unit,
                   border_is_struck(&table, i, own) ? "stands | falls" : "holds | fails");
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
    printf("  %-*s %s %s", LABEL_WIDTH, label, show(row->value).text, verdict_words[row->verdict]);
    if (!isnan(row->drift)) printf(", %s m", show(row->drift).text);
    if (!isnan(row->energy)) printf(", %s J", show(row->energy).text);
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
                   VERDICT_DRIFT_UNITS);
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
        if (!isnan(row->differs)) printf("; not deterministic: two runs at %s differ", show(row->differs).text);
        printf("\n");
    }
    csv_table_free(&table);
    printf("programs and their failures -> %s\n", path);
    return true;
}

static bool print_tables(const char *folder, const StabilityOwn *own, Error *error) {
    if (!print_borders(folder, own, error) || !print_rest(folder, error) || !print_engines(folder, error)) return false;
    printf("borders -> %s/stability.csv; maps -> %s/maps.csv\n", folder, folder);
    printf("their figures -> %s/borders.png, %s/map-NAME.png\n", folder, folder);
    printf("links to live pages -> %s/stability.html\n", folder);
    printf("why methods do not apply -> %s/refusals.csv\n", folder);
    printf("discarded outputs of networks, steps that fell back -> %s/fallbacks.csv\n", folder);
    printf("drift and energy at rest -> %s/rest.csv\n", folder);
    return print_unconverged(folder, error);
}

/* One parameter more than can be varied, which stability_own_make() then refuses. */
enum { VARY_TEXTS = STABILITY_MAX_VARY + 1 };

typedef struct Options {
    StabilityOptions study;
    const char *scene; /* or NULL */
    int vary_count;
    const char *vary[VARY_TEXTS];
} Options;

/* Of studies and maps, for completion. */
static const char *study_names[64];

static void list_names(void) {
    enum { MOST = sizeof study_names / sizeof *study_names - 1 };
    int count = 0;
    for (int i = 0; i < stability_study_count && count < MOST; i++) study_names[count++] = stability_studies[i].name;
    for (int i = 0; i < stability_map_count && count < MOST; i++) study_names[count++] = stability_maps[i].name;
}

static const Option option_table[] = {
    {"--output", 'o', "DIR",
     "Folder for stability.csv, maps.csv, refusals.csv, fallbacks.csv, rest.csv, unconverged.csv and the figures",
     OPTION_TEXT(Options, study.folder), .needed = "-o DIR is needed"},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone makes as many sweeps as the scene sets (default: all that the study "
     "does not report as left out)",
     OPTION_METHOD(Options, study.methods)},
    {"--vary", 0, "NAME[=FROM:TO[:STEP]]",
     "Vary a parameter of SCENE, by default between its bounds, or what every scene has: iterations, dt, friction, "
     "bomb_x, bomb_y, bomb_mass, bomb_speed; with STEP at every such value, up to 128; two of them also give their map",
     OPTION_TEXTS(Options, vary, vary_count)},
    {"--study", 0, "NAME", "Only this study or map (may be repeated; default: all)",
     OPTION_TEXTS(Options, study.names, study.name_count), .names = study_names},
    {"--scenes", 0, "DIR",
     "Folder whose subfolder stability/ has the scenes (default: scenes, or the installed scenes)",
     OPTION_TEXT(Options, study.scenes)},
    {"--quick", 0, NULL, "Few studies, small maps: under two minutes; of SCENE: few values",
     OPTION_FLAG(Options, study.quick)},
    {OPTION_SHARD(Options, study.shard)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "[SCENE]", OPTION_PATH(Options, scene)},
    .inputs = {0, 1, "scene"},
    .help =
        "Find where each method fails. Along one parameter of a scene (height of a stack, mass ratio, time step, "
        "...): every border between holding and failing, and how it fails there. Over two parameters: maps. A run "
        "holds if no box falls, also where a bomb or a moving body strikes; figures of such scenes are hatched where "
        "a method does not what the converged run does. Takes some four minutes on two cores. An interrupted run "
        "continues where it stopped.\n"
        "With SCENE: the same along one or two parameters, of that scene or of every scene. A parameter takes 13 runs "
        "of every method and about ten more for each border, a map 100, each as long as the scene's frames.\n"
        "The verdicts in stability.html link into a live page of each scene, which steps it with the values of that "
        "place.\v"
        "Example: twinbox stability -o out/stability\n"
        "         twinbox new wall.yaml --like wall\n"
        "         twinbox stability wall.yaml --vary pairs --vary bomb_mass -o out/wall\n"
        "         twinbox stability stack --vary iterations --quick -o out/borders\n"
        "         twinbox stability --study stack_height --methods engine -o out/height"};

static bool draw(const StabilityOptions *options, Error *error) {
    const bool drawn = stability_figures_write(options->folder, options->own, progress_bar_begin("maps"), error);
    progress_bar_end();
    return drawn;
}

static bool run_study(const StabilityOptions *options, Error *error) {
    Pieces pieces = {0};
    const bool ok = stability_run(options, &pieces, progress_bar_begin("stability"), error);
    progress_bar_end();
    if (!ok) return false;
    if (options->shard.count > 0) {
        shard_option_print(&pieces);
        return true;
    }
    if (!print_tables(options->folder, options->own, error)) return false;
    const NameList left_out = contenders_left_out(STUDY_STABILITY);
    if (options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return true;
}

/* SCENE and --vary go together, and neither with what chooses studies of the table. */
static bool check_options(const Options *options, Error *error) {
    if (options->scene == NULL)
        return options->vary_count == 0 || error_input(error, "--vary", "a scene is needed: its parameters are varied");
    if (options->vary_count == 0)
        return error_input(error, options->scene,
                           "--vary NAME is needed: a parameter of the scene, or iterations, dt, friction, bomb_x, "
                           "bomb_y, bomb_mass or bomb_speed");
    return options->study.name_count == 0 ||
           error_input(error, "--study", "is for the studies without SCENE; '%s' is given", options->scene);
}

bool command_stability(int argc, char **argv, Error *error) {
    Options options = {.study = {.scenes = installed_path("scenes"), .draw = draw}};
    StabilityOwn own;
    list_names();
    if (!options_parse(&spec, argc, argv, &options, error) || !check_options(&options, error)) return false;
    if (options.scene != NULL) {
        if (!stability_own_make(&own, options.scene, options.vary, options.vary_count, options.study.quick, error))
            return false;
        options.study.own = &own;
    }
    return output_check_folder(options.study.folder, error) && run_study(&options.study, error);
}
