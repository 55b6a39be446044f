/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox chart: what it prints of the charts. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/installed.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "pixels/type.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/equal_time.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct Options {
    SpeedAccuracyOptions study;
    const char *scenes[STUDY_MAX_SCENES];
} Options;

/* A number, or the path of a table. */
static bool read_launches(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)error;
    LaunchChoice *launches = value;
    int64_t count;
    const bool number = parse_int(text, 1, LAUNCHES_MAX, &count);
    launches->count = number ? (int)count : 0;
    launches->table = number ? NULL : installed_path(text);
    return true;
}

static bool read_size(const Option *option, const char *text, void *value, Error *error) {
    static const char *const sizes[] = {[CHART_PAGE] = "page", [CHART_COLUMN] = "column", [CHART_SLIDE] = "slide"};
    for (int i = 0; i < (int)(sizeof sizes / sizeof *sizes); i++)
        if (strcmp(text, sizes[i]) == 0) {
            *(ChartSize *)value = (ChartSize)i;
            return true;
        }
    return error_input(error, option->name, "'%s' is not page, column or slide", text);
}

static const Option option_table[] = {
    {"--output", 'o', "DIR", "Folder for chart.csv and the charts", OPTION_TEXT(Options, study.folder),
     .needed = "-o DIR is needed"},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone stands for all settings that the chart has for it (default: all; "
     "methods left out are reported); those named are in colour, as far as there are six",
     OPTION_METHOD(Options, study.methods)},
    {"--launches", 0, "N|FILE.csv",
     "Launches to score on: N held-out launches of the scene's family (default: 40, fewer above 110 bodies), or a "
     "table with any of the columns x,rotation,spin,mass,frame",
     OPTION_READ(read_launches, Options, study.launches)},
    {"--bomb-x", 0, "A:B:STEP", "Launches to score on: x from A to B in steps of STEP, m",
     OPTION_RANGE(Options, study.launches.bomb_x)},
    {"--quick", 0, NULL, "Fewer launches, settings and repetitions: under a minute", OPTION_FLAG(Options, study.quick)},
    {"--highlight", 0, "NAME,...", "Methods to draw in colour, beside the engine, interior and the strongest rival",
     OPTION_TEXT(Options, study.look.highlight)},
    {"--size", 0, "page|column|slide",
     "174 x 92 mm, two columns of a paper; 85 x 144 mm, one column; or 160 x 90 mm, 16:9 (default: page)",
     OPTION_READ(read_size, Options, study.look.size)},
    {OPTION_COLOUR(Options, study.look.colours)},
    {"--frozen", 0, NULL,
     "Draw errors on steps that the engine's runs recorded, which methods that lose the scene have, too",
     OPTION_FLAG(Options, study.look.frozen)},
    {"--words", 0, NULL, "Also write the caption below the picture", OPTION_FLAG(Options, study.look.words)},
    {OPTION_SHARD(Options, study.shard)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE...|CHART.csv",
              .needed = "a scene file, or the chart.csv of an earlier run, is needed",
              OPTION_PATHS(Options, scenes, study.scene_count)},
    .inputs = {1, STUDY_MAX_SCENES, "scene"},
    .help =
        "Measure speed against accuracy: every method in every scene, on held-out launches. Writes chart.csv and a "
        "chart for each scene (PNG, SVG, PDF), and chart.html, whose points link into a live page of the scene, which "
        "steps it with the launch that was worst for the method. An interrupted run continues where it stopped. With "
        "the chart.csv of an earlier run, only draws its charts again.\v"
        "Example: twinbox chart stack pyramid_settled -o out/chart\n"
        "         twinbox chart stack -o out/few --methods engine,momentum:k=20 --quick\n"
        "         twinbox chart out/few/chart.csv -o out/drawn"};

/* The chart of scene i of `count`; what: its line says. A signal is noticed between two charts. */
static bool draw_scene(const char *csv, const char *scene, const char *what, const SpeedAccuracyOptions *options, int i,
                       int count, Error *error) {
    const char *folder = options->folder;
    if (!progress_report(progress_bar_begin("charts"), i, count))
        return error_interrupted(error, folder, "stopped; chart.csv is finished");
    if (!chart_plot(csv, scene, folder, &options->look, error)) return false;
    printf("%s%s -> %s/chart-%s.png, .svg, .pdf, .txt\n", scene, what, folder, scene);
    return true;
}

static bool draw_equal_time(const char *csv, const char *folder, Error *error) {
    EqualTimeFigure figure;
    if (!equal_time_plot(csv, folder, &figure, error)) return false;
    printf("error at equal time -> %s/equal_time.csv, equal_time_methods.csv%s\n", folder,
           figure.drawn ? ", equal_time.png, .svg, .pdf, .txt" : "");
    if (figure.drawn && figure.left_out.used > 0)
        printf("    left out of the figure, as without a ratio: %s\n", figure.left_out.text);
    return true;
}

/* The charts of a finished table. */
static bool draw_again(const SpeedAccuracyOptions *options, const char *csv, Error *error) {
    CsvTable table;
    if (options->scene_count > 1 || options->methods != NULL || options->quick || options->shard.count > 0 ||
        options->launches.count > 0 || options->launches.table != NULL || options->launches.bomb_x.count > 0)
        return error_input(error, csv, "a finished chart is drawn as it is: give only this file and -o DIR");
    if (!csv_table_read(&table, csv, &chart_layout, error)) return false;
    bool drawn = chart_colours_check(&options->look.colours, table.rows, table.count, error) &&
                 chart_highlight_check(options->look.highlight, table.rows, table.count, error) &&
                 folder_reserve(options->folder, error);
    for (int i = 0; drawn && i < table.count; i++) {
        const char *scene = chart_row(&table, i)->scene;
        int first = 0;
        while (strcmp(chart_row(&table, first)->scene, scene) != 0) first++;
        drawn = first < i || draw_scene(csv, scene, "", options, i, table.count, error);
    }
    drawn = drawn && draw_equal_time(csv, options->folder, error);
    progress_bar_end();
    csv_table_free(&table);
    return drawn;
}

static bool draw_measured(const SpeedAccuracyOptions *options, const char *csv, const SpeedAccuracyScene *scene, int i,
                          Error *error) {
    char what[96];
    snprintf(what, sizeof what, ": %d method%s and settings, %d launch%s", scene->contenders, plural(scene->contenders),
             scene->launches, plural_es(scene->launches));
    if (scene->striking < scene->launches)
        text_add(what, sizeof what, " of which %d strike%s a box", scene->striking, scene->striking == 1 ? "s" : "");
    if (!draw_scene(csv, scene->name, what, options, i, options->scene_count, error)) return false;
    const char *without = scene->without_network.text;
    if (without[0] != '\0') printf("    left out, as no network is named for them: %s\n", without);
    const SceneSolves *solves = &scene->solves;
    printf("    not scored, as the reference does not converge: %" PRId64 " of %" PRId64 " frozen steps, %" PRId64
           " of %" PRId64 " in closed loop\n",
           solves->frozen_unconverged, solves->frozen, solves->closed_unconverged, solves->closed);
    if (solves->runs_unconverged > 0)
        printf("    energy and drift are compared before the converged runs' steps that did not converge: %" PRId64
               "\n",
               solves->runs_unconverged);
    return true;
}

static bool chart_draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, Error *error) {
    char csv[CSV_PATH_SIZE];
    if (!csv_table_path(csv, options->folder, &chart_layout, error)) return false;
    for (int i = 0; i < options->scene_count; i++)
        if (!draw_measured(options, csv, &scenes[i], i, error)) return false;
    if (!draw_equal_time(csv, options->folder, error)) return false;
    const NameList left_out = contenders_left_out(options->quick ? STUDY_CHART_QUICK : STUDY_CHART);
    if (options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    if (programs_failure() != NULL) note_print("runs ended early: %s", programs_failure());
    printf("points with links to live pages -> %s/chart.html\n", options->folder);
    if (options->scene_count == 1)
        next_print((const char *const[]){"stability", options->scenes[0], "--vary", "iterations", "--quick", "-o",
                                         next_path(scenes[0].name, "-borders").text, NULL});
    return true;
}

/* Before the work: a name that no method of the study has. */
static bool check_look(const SpeedAccuracyOptions *options, Error *error) {
    ContenderList contenders;
    if (options->look.highlight == NULL && options->look.colours.count == 0) return true;
    if (!contenders_parse(&contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    ChartRow *rows = calloc((size_t)contenders.count + 1, sizeof *rows);
    for (int i = 0; rows != NULL && i < contenders.count; i++)
        rows[i] = (ChartRow){.method = contenders.items[i].name, .setting = contenders.items[i].setting};
    const bool ok = (rows != NULL || error_memory(error, "--highlight")) &&
                    chart_colours_check(&options->look.colours, rows, contenders.count, error) &&
                    chart_highlight_check(options->look.highlight, rows, contenders.count, error);
    free(rows);
    contenders_free(&contenders);
    return ok;
}

/* Before the work, so that the family can be changed first. */
static void note_misses(const SpeedAccuracyScene *scene) {
    const int missed = scene->launches - scene->striking;
    if (missed > 0)
        note_print("%s: %d of %d launch%s strike%s no box; the impact is scored and timed on the others", scene->name,
                   missed, scene->launches, plural_es(scene->launches), missed == 1 ? "s" : "");
}

bool command_chart(int argc, char **argv, Error *error) {
    Options options = {0};
    options.study.scenes = options.scenes;
    options.study.begin = note_misses;
    options.study.draw = chart_draw;
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const LaunchChoice *launches = &options.study.launches;
    if (launches->bomb_x.count > 0 && (launches->table != NULL || launches->count > 0))
        return error_input(error, "--bomb-x", "cannot be combined with --launches");
    for (int i = 0; i < options.study.scene_count; i++)
        if (file_name_ends_with(options.scenes[i], ".csv")) return draw_again(&options.study, options.scenes[i], error);
    for (int i = 0; i < options.study.scene_count; i++) { /* a scene has its file's name */
        const char *path = options.scenes[i];
        if (!type_check(path + file_folder_length(path), path, error)) return false;
    }
    options.study.look.chosen = options.study.methods != NULL;
    if (!check_look(&options.study, error) || !output_check_folder(options.study.folder, error)) return false;
    Pieces pieces = {0};
    SpeedAccuracyScene scenes[STUDY_MAX_SCENES];
    const bool ok = speed_accuracy_run(&options.study, &pieces, progress_bar_begin("chart"), scenes, error);
    progress_bar_end();
    if (ok && options.study.shard.count > 0) shard_option_print(&pieces);
    return ok;
}
