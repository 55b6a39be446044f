/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox chart: the command, and the pages of a chart, each of which plays the launch that was worst for a point
   beside the converged run. */
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
#include "cli/page_set.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "pictures/player.h"
#include "pixels/type.h"
#include "runs/pieces.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_pages.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/equal_time.h"
#include "studies/piece_tables.h"
#include "studies/scene_study.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TITLE_SIZE = CHART_NAME_SIZE + 64 };

/* s before the bomb touches, and after the last frame of the phase "after". */
static const double margin = 0.25;

typedef struct Pages {
    PageSet set;
    const SpeedAccuracyOptions *options;
    const SpeedAccuracyScene *scenes;
    ContenderList contenders;
    Method reference;
    int scene;              /* the current one; -1: not yet */
    SceneStudy study;       /* of the scene */
    Trajectory **converged; /* [launches] as far as they were needed; NULL: not */
    int contender;          /* the current one */
} Pages;

/* The converged run of a launch, with at least so many frames. */
static const Trajectory *converged_run(Pages *pages, const Scene *scene, int launch, Error *error) {
    Trajectory **run = &pages->converged[launch];
    if (*run != NULL && (*run)->frames > scene->frames) return *run;
    trajectory_destroy(*run);
    return *run = simulate(scene, &pages->reference, NULL, error);
}

/* Both runs, from before the bomb touches until after the phase "after". */
static bool write_page(Pages *pages, const Contender *contender, const WorstLaunch *worst, PageFile *file,
                       Error *error) {
    char name[3 * CHART_NAME_SIZE], title[TITLE_SIZE];
    Scene scene = scene_study_launch(&pages->study, worst->launch);
    const int around = (int)lround(margin / (double)scene.dt);
    const int end = worst->touch + scene.bomb.impact_frames + AFTER_FRAMES + around;
    scene.frames = end < worst->frames ? end : worst->frames;
    const Trajectory *converged = converged_run(pages, &scene, worst->launch, error);
    Trajectory *run = converged != NULL ? simulate(&scene, &contender->method, NULL, error) : NULL;
    if (run == NULL) return false;
    snprintf(name, sizeof name, "%s-%s-%d-launch-%d", scene.name, contender->name, pages->contender + 1,
             worst->launch + 1);
    snprintf(title, sizeof title, "%s, launch %d from x = %.4g m", scene.name, worst->launch + 1,
             (double)launch_of(&scene).x);
    const char *const methods[] = {converged->method, run->method};
    const PlayerOptions options = {.colours = colours_of_these(&pages->options->look.colours, methods, 2),
                                   .first = worst->touch > around ? worst->touch - around : 0,
                                   .last = scene.frames,
                                   .title = title,
                                   .describe = method_describe};
    const bool done =
        page_set_write(&pages->set, name, (const Trajectory *const[]){converged, run}, 2, &options, file, error);
    trajectory_destroy(run);
    return done;
}

static LaunchPage chart_describe(const Pages *pages, const Contender *contender, const WorstLaunch *worst, int phase) {
    const Launch launch = pages->study.launches[worst->launch];
    return (LaunchPage){.scene = pages->study.scene->name,
                        .method = contender->name,
                        .setting = contender->setting,
                        .phase = (Phase)phase,
                        .launch = worst->launch + 1,
                        .x = launch.x,
                        .rotation = launch.rotation,
                        .spin = launch.spin,
                        .mass = launch.mass,
                        .launch_frame = launch.frame,
                        .error_worst = worst->mean,
                        .error = worst->error,
                        .time = worst->frame * (double)pages->study.scene->dt,
                        .frame = worst->frame,
                        .body = worst->body};
}

static void end_scene(Pages *pages) {
    for (int i = 0; pages->converged != NULL && i < pages->study.launch_count; i++)
        trajectory_destroy(pages->converged[i]);
    free(pages->converged);
    pages->converged = NULL;
    scene_study_end(&pages->study);
}

/* Parts are the contenders of scene after scene. */
static bool chart_enter(Pages *pages, int part, Error *error) {
    int scene = 0, first = 0;
    while (part >= first + pages->scenes[scene].contenders) first += pages->scenes[scene++].contenders;
    pages->contender = part - first;
    if (scene == pages->scene) return true;
    end_scene(pages);
    pages->scene = scene;
    if (!scene_study_begin(&pages->study, pages->options->scenes[scene], &pages->contenders, &pages->options->launches,
                           speed_accuracy_size(pages->options->quick), error))
        return false;
    pages->converged = calloc((size_t)pages->study.launch_count, sizeof *pages->converged);
    return pages->converged != NULL || error_memory(error, "pages");
}

/* Both phases have one page if they have the same worst launch. */
static bool write_contender(void *context, int part, FILE *rows, const Progress *progress, Error *error) {
    Pages *pages = context;
    WorstLaunch worst[PHASES];
    PageFile file = {0};
    char link[PAGE_LINK_SIZE];
    if (!chart_enter(pages, part, error)) return false;
    const Contender *contender = pages->study.contenders[pages->contender];
    if (!worst_launch_find(&pages->study, &contender->method, worst, progress, error)) return false;
    for (int phase = PHASE_IMPACT; phase <= PHASE_AFTER; phase++) {
        if (worst[phase].launch < 0) continue;
        const bool same = phase == PHASE_AFTER && worst[phase].launch == worst[PHASE_IMPACT].launch;
        if (!same && !write_page(pages, contender, &worst[phase], &file, error)) return false;
        LaunchPage row = chart_describe(pages, contender, &worst[phase], phase);
        page_set_link(link, &file, row.time, row.body, 1);
        row.page = link;
        row.bytes = file.bytes;
        if (!piece_tables_print(rows, &launch_page_layout, -1, &row, error)) return false;
    }
    return true;
}

/* Runs again what the chart has measured, and writes folder/pages/SCENE-METHOD-N-launch-L.html, folder/chart_pages.csv
   (studies/chart_pages.h) and folder/chart.html, whose points and table link to the pages. A page begins a quarter of a
   second before the bomb touches and ends as long after the last scored step. Prints how many pages there are, and what
   was left out. */
static bool chart_pages_write(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key,
                              Error *error) {
    Pages pages = {
        .options = options,
        .scenes = scenes,
        .scene = -1,
        .set = {.folder = options->folder, .layout = &launch_page_layout, .write = write_contender, .context = &pages}};
    for (int i = 0; i < options->scene_count; i++) pages.set.parts += scenes[i].contenders;
    if (!contenders_parse(&pages.contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    const bool ok = method_parse(&pages.reference, "reference", error) &&
                    page_set_make(&pages.set, key, progress_bar_begin("pages"), error) &&
                    chart_html_write(options->folder, &options->look, error) && page_set_end(&pages.set, error);
    progress_bar_end();
    end_scene(&pages);
    contenders_free(&pages.contenders);
    if (ok) page_set_print(&pages.set, "chart.html");
    return ok;
}

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
     "methods left out are reported)",
     OPTION_METHOD(Options, study.methods)},
    {"--launches", 0, "N|FILE.csv",
     "Launches to score on: N held-out launches of the scene's family (default: 40, fewer above 110 bodies), or a "
     "table with any of the columns x,rotation,spin,mass,frame",
     OPTION_READ(read_launches, Options, study.launches)},
    {"--bomb-x", 0, "A:B:STEP", "Launches to score on: x from A to B in steps of STEP, m",
     OPTION_RANGE(Options, study.launches.bomb_x)},
    {"--quick", 0, NULL, "Fewer launches, settings and repetitions: under a minute", OPTION_FLAG(Options, study.quick)},
    {"--pages", 0, NULL,
     "Also write chart.html, whose points link to pages that play the launch that was worst for them",
     OPTION_FLAG(Options, study.pages)},
    {"--highlight", 0, "NAME,...", "Methods to draw in colour, beside the engine, interior and the strongest rival",
     OPTION_TEXT(Options, study.look.highlight)},
    {"--size", 0, "page|column|slide",
     "174 x 92 mm, two columns of a paper; 85 x 144 mm, one column; or 160 x 90 mm, 16:9 (default: page)",
     OPTION_READ(read_size, Options, study.look.size)},
    {OPTION_COLOUR(Options, study.look.colours)},
    {"--words", 0, NULL, "Also write the caption below the picture", OPTION_FLAG(Options, study.look.words)},
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
        "Example: twinbox chart stack pyramid_settled -o out/chart\n"
        "         twinbox chart stack -o out/few --methods engine,momentum:k=20 --quick\n"
        "         twinbox chart out/few/chart.csv -o out/drawn"};

/* A scene and what its line says. */
typedef struct Drawn {
    const char *scene, *what;
    bool timed; /* else there is nothing to draw */
} Drawn;

/* The chart of scene i of `count`. A signal is noticed between two charts. */
static bool draw_scene(const char *csv, const Drawn *drawn, const SpeedAccuracyOptions *options, int i, int count,
                       Error *error) {
    const char *folder = options->folder;
    if (!progress_report(progress_bar_begin("charts"), i, count))
        return error_interrupted(error, folder, "stopped; chart.csv is finished");
    if (!drawn->timed) {
        printf("%s%s: no chart, as its times were measured on another processor than the first\n", drawn->scene,
               drawn->what);
        return true;
    }
    if (!chart_plot(csv, drawn->scene, folder, &options->look, error)) return false;
    printf("%s%s -> %s/chart-%s.png, .svg, .pdf, .txt\n", drawn->scene, drawn->what, folder, drawn->scene);
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

static bool draw_scenes(const CsvTable *table, const char *csv, const SpeedAccuracyOptions *options, Error *error) {
    for (int i = 0; i < table->count; i++) {
        int first = 0;
        while (strcmp(chart_row(table, first)->scene, chart_row(table, i)->scene) != 0) first++;
        if (first < i) continue;
        const char *scene = chart_row(table, i)->scene;
        const Drawn drawn = {scene, "", !chart_scene_untimed(table->rows, table->count, scene)};
        if (!draw_scene(csv, &drawn, options, i, table->count, error)) return false;
    }
    return true;
}

/* The charts of a finished table. */
static bool draw_again(const Options *given, const char *csv, Error *error) {
    const SpeedAccuracyOptions *options = &given->study;
    CsvTable table;
    if (options->scene_count > 1 || options->methods != NULL || options->quick || options->pages ||
        given->shard != NULL || options->launches.count > 0 || options->launches.table != NULL ||
        options->launches.bomb_x.count > 0)
        return error_input(error, csv, "a finished chart is drawn as it is: give only this file and -o DIR");
    if (!csv_table_read(&table, csv, &chart_layout, error)) return false;
    const bool drawn = chart_colours_check(&options->look.colours, table.rows, table.count, error) &&
                       chart_highlight_check(options->look.highlight, table.rows, table.count, error) &&
                       folder_reserve(options->folder, error) && draw_scenes(&table, csv, options, error) &&
                       draw_equal_time(csv, options->folder, error);
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
    const Drawn drawn = {scene->name, what, scene->timed};
    if (!draw_scene(csv, &drawn, options, i, options->scene_count, error)) return false;
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

static bool chart_draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key,
                       Error *error) {
    char csv[CSV_PATH_SIZE];
    if (!csv_table_path(csv, options->folder, &chart_layout, error)) return false;
    for (int i = 0; i < options->scene_count; i++)
        if (!draw_measured(options, csv, &scenes[i], i, error)) return false;
    if (!draw_equal_time(csv, options->folder, error)) return false;
    const NameList left_out = contenders_left_out(options->quick ? STUDY_CHART_QUICK : STUDY_CHART);
    if (options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    if (programs_failure() != NULL) note_print("runs ended early: %s", programs_failure());
    if (options->pages && !chart_pages_write(options, scenes, key, error)) return false;
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

static bool chart_study(const SpeedAccuracyOptions *options, Error *error) {
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
    options.study.begin = note_misses;
    options.study.draw = chart_draw;
    options.study.run = &run;
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const LaunchChoice *launches = &options.study.launches;
    if (launches->bomb_x.count > 0 && (launches->table != NULL || launches->count > 0))
        return error_input(error, "--bomb-x", "cannot be combined with --launches");
    for (int i = 0; i < options.study.scene_count; i++)
        if (file_name_ends_with(options.scenes[i], ".csv")) return draw_again(&options, options.scenes[i], error);
    for (int i = 0; i < options.study.scene_count; i++) { /* a scene has its file's name */
        const char *path = options.scenes[i];
        if (!type_check(path + file_folder_length(path), path, error)) return false;
    }
    return shard_option_take(&run, options.shard, argc, argv, error) && check_look(&options.study, error) &&
           output_check_folder(options.study.folder, error) && chart_study(&options.study, error);
}
