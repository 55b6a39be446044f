/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_plot.h"
#include "chart/equal_time_plot.h"
#include "cli/chart_pages.h"
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/shard_option.h"
#include "common/file.h"
#include "common/folder_reserve.h"
#include "npz/output_check.h"
#include "study/chart_rows.h"
#include "study/speed_accuracy.h"
#include "type/type_check.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct Options {
    SpeedAccuracyOptions study;
    const char *scenes[STUDY_MAX_SCENES];
    const char *shard; /* or NULL */
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

static const Option option_table[] = {
    {"--output", 'o', "DIR", "Folder for chart.csv and the charts", OPTION_TEXT(Options, study.folder),
     .needed = "-o DIR is needed"},
    {"--methods", 0, "LIST",
     "Methods, separated by commas; a name alone stands for all settings that the chart has for it (default: all; "
     "methods left out are reported)",
     OPTION_TEXT(Options, study.methods)},
    {"--launches", 0, "N|FILE.csv",
     "Launches to score on: N held-out launches of the scene's family (default: 40, fewer above 110 bodies), or a "
     "table with any of the "
     "columns x,rotation,spin,mass,frame",
     OPTION_READ(read_launches, Options, study.launches)},
    {"--bomb-x", 0, "A:B:STEP", "Launches to score on: x from A to B in steps of STEP, m",
     OPTION_RANGE(Options, study.launches.bomb_x)},
    {"--quick", 0, NULL, "Fewer launches, settings and repetitions: under a minute", OPTION_FLAG(Options, study.quick)},
    {"--pages", 0, NULL,
     "Also write chart.html, whose points link to pages that play the launch that was worst for them",
     OPTION_FLAG(Options, study.pages)},
    {OPTION_SHARD(Options, shard)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE...|CHART.csv",
              .needed = "a scene file, or the chart.csv of an earlier run, is needed",
              OPTION_PATHS(Options, scenes, study.scene_count)},
    .inputs = {1, STUDY_MAX_SCENES, "scene"},
    .help =
        "Measure speed against accuracy: every method in every scene, on held-out launches. Writes chart.csv and a "
        "chart for each scene (PNG, SVG, PDF). An interrupted run continues where it stopped. With the chart.csv of an "
        "earlier run, only draws its charts again.\n"
        "With --pages, every launch is run once more. A page has the worst launch of a method and setting beside the "
        "converged run, opened at the step with the largest error: at most two pages of each, from before the impact "
        "to the end of what the chart measures, and at most 256 MB of pages.\v"
        "Example: twinbox chart scenes/stack.yaml scenes/pyramid_settled.yaml -o out/chart\n"
        "         twinbox chart scenes/stack.yaml -o out/few --methods engine,momentum:k=20 --quick\n"
        "         twinbox chart out/chart/chart.csv -o out/drawn"};

/* A scene and what its line says. */
typedef struct Drawn {
    const char *scene, *what;
    bool timed; /* else there is nothing to draw */
} Drawn;

/* The chart of scene i of `count`. A signal is noticed between two charts. */
static bool draw_scene(const char *csv, const Drawn *drawn, const char *folder, int i, int count, Error *error) {
    if (!progress_report(progress_bar_begin("charts"), i, count))
        return error_interrupted(error, folder, "stopped; chart.csv is finished");
    if (!drawn->timed) {
        printf("%s%s: no chart, as its times were measured on another processor than the first\n", drawn->scene,
               drawn->what);
        return true;
    }
    if (!chart_plot(csv, drawn->scene, folder, error)) return false;
    printf("%s%s -> %s/chart-%s.png, .svg, .pdf\n", drawn->scene, drawn->what, folder, drawn->scene);
    return true;
}

static bool draw_equal_time(const char *csv, const char *folder, Error *error) {
    bool drawn;
    if (!equal_time_plot(csv, folder, &drawn, error)) return false;
    printf("error at equal time -> %s/equal_time.csv, equal_time_methods.csv%s\n", folder,
           drawn ? ", equal_time.png, .svg, .pdf" : "");
    return true;
}

static bool is_table(const char *path) {
    const size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".csv") == 0;
}

static bool draw_scenes(const ChartTable *table, const char *csv, const char *folder, Error *error) {
    for (int i = 0; i < table->count; i++) {
        int first = 0;
        while (strcmp(table->rows[first].scene, table->rows[i].scene) != 0) first++;
        if (first < i) continue;
        const char *scene = table->rows[i].scene;
        const Drawn drawn = {scene, "", !chart_scene_untimed(table->rows, table->count, scene)};
        if (!draw_scene(csv, &drawn, folder, i, table->count, error)) return false;
    }
    return true;
}

/* The charts of a finished table. */
static bool draw_again(const Options *given, const char *csv, Error *error) {
    const SpeedAccuracyOptions *options = &given->study;
    ChartTable table;
    if (options->scene_count > 1 || options->methods != NULL || options->quick || options->pages ||
        given->shard != NULL || options->launches.count > 0 || options->launches.table != NULL ||
        options->launches.bomb_x.count > 0)
        return error_input(error, csv, "a finished chart is drawn as it is: give only this file and -o DIR");
    if (!chart_csv_read(&table, csv, error)) return false;
    const bool drawn = folder_reserve(options->folder, error) && draw_scenes(&table, csv, options->folder, error) &&
                       draw_equal_time(csv, options->folder, error);
    progress_bar_end();
    chart_csv_free(&table);
    return drawn;
}

static bool draw_measured(const SpeedAccuracyOptions *options, const char *csv, const SpeedAccuracyScene *scene, int i,
                          Error *error) {
    char what[64];
    snprintf(what, sizeof what, ": %d methods and settings, %d launches", scene->contenders, scene->launches);
    const Drawn drawn = {scene->name, what, scene->timed};
    if (!draw_scene(csv, &drawn, options->folder, i, options->scene_count, error)) return false;
    const char *without = scene->without_network.text;
    if (without[0] != '\0') printf("    left out, as no network is named for them: %s\n", without);
    printf("    reference: residual at most %.1g m/s in frozen steps; above 1 mm/s in %" PRId64 " of %" PRId64
           " steps in closed loop\n",
           scene->solves.frozen_residual, scene->solves.unconverged, scene->solves.solves);
    return true;
}

static bool draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key, Error *error) {
    char csv[CSV_PATH_SIZE];
    if (!csv_table_path(csv, options->folder, &chart_layout, error)) return false;
    for (int i = 0; i < options->scene_count; i++)
        if (!draw_measured(options, csv, &scenes[i], i, error)) return false;
    if (!draw_equal_time(csv, options->folder, error)) return false;
    const NameList left_out = contenders_left_out(options->quick ? STUDY_CHART_QUICK : STUDY_CHART);
    if (options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return !options->pages || chart_pages_write(options, scenes, key, error);
}

static bool study(const SpeedAccuracyOptions *options, Error *error) {
    Pieces pieces = {0};
    SpeedAccuracyScene scenes[STUDY_MAX_SCENES];
    const bool ok = speed_accuracy_run(options, &pieces, progress_bar_begin("chart"), scenes, error);
    progress_bar_end();
    if (ok && pieces.mode == PIECES_SHARD) shard_option_print(&pieces, options->folder);
    return ok;
}

bool command_chart(int argc, char **argv, Error *error) {
    Options options = {0};
    PiecesRun run;
    options.study.scenes = options.scenes;
    options.study.draw = draw;
    options.study.run = &run;
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const LaunchChoice *launches = &options.study.launches;
    if (launches->bomb_x.count > 0 && (launches->table != NULL || launches->count > 0))
        return error_input(error, "--bomb-x", "cannot be combined with --launches");
    for (int i = 0; i < options.study.scene_count; i++)
        if (is_table(options.scenes[i])) return draw_again(&options, options.scenes[i], error);
    for (int i = 0; i < options.study.scene_count; i++) { /* a scene has its file's name */
        const char *path = options.scenes[i];
        if (!type_check(path + file_folder_length(path), path, error)) return false;
    }
    return shard_option_take(&run, options.shard, argc, argv, error) &&
           output_check_folder(options.study.folder, error) && study(&options.study, error);
}
