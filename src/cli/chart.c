/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_plot.h"
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "common/file.h"
#include "study/speed_accuracy.h"

#include <stdio.h>
#include <string.h>

enum { METHODS = 256, LAUNCHES, QUICK };

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0, "Folder for chart.csv and the charts", 0},
    {"methods", METHODS, "LIST", 0,
     "Methods, separated by commas; a name alone stands for all settings that the chart has for it (default: all; "
     "methods left out are reported)",
     0},
    {"launches", LAUNCHES, "FILE.csv", 0,
     "Launches to score on, a table with any of the columns x,rotation,spin,mass,frame (default: x halfway between the "
     "places of the training grid)",
     0},
    {"quick", QUICK, NULL, 0, "Fewer launches, settings and repetitions: under a minute", 0},
    {0}};

typedef struct Options {
    SpeedAccuracyOptions study;
    const char *scenes[STUDY_MAX_SCENES];
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->study.folder = value; break;
    case METHODS: options->study.methods = value; break;
    case LAUNCHES: options->study.launches = installed_path(value); break;
    case QUICK: options->study.quick = true; break;
    case ARGP_KEY_ARG:
        if (options->study.scene_count == STUDY_MAX_SCENES) argp_error(state, "at most %d scenes", STUDY_MAX_SCENES);
        options->scenes[options->study.scene_count++] = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->study.scene_count == 0) argp_error(state, "a scene file is needed");
        if (options->study.folder == NULL) argp_error(state, "-o DIR is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "SCENE...",
    "Measure speed against accuracy: every method in every scene, on held-out launches. Writes chart.csv and a chart "
    "for each scene (PNG, SVG, PDF). An interrupted run continues where it stopped.\v"
    "Example: twinbox chart scenes/stack.yaml scenes/pyramid_settled.yaml -o out/chart\n"
    "         twinbox chart scenes/stack.yaml -o out/few --methods engine,momentum:k=20 --quick",
    NULL,
    NULL,
    NULL};

/* Progress bars, one after the other. */
typedef struct Stages {
    ProgressBar bar;
    char what[192];
    bool begun;
} Stages;

static void end_stage(Stages *stages) {
    if (stages->begun) progress_bar_end(&stages->bar);
    stages->begun = false;
}

static const Progress *begin_stage(void *context, const char *what) {
    Stages *stages = context;
    end_stage(stages);
    snprintf(stages->what, sizeof stages->what, "%s", what);
    progress_bar_begin(&stages->bar, stages->what);
    stages->begun = true;
    return &stages->bar.progress;
}

static bool draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, Error *error) {
    char csv[CSV_PATH_SIZE];
    if (!csv_table_path(csv, options->folder, &chart_layout, error)) return false;
    for (int i = 0; i < options->scene_count; i++) {
        if (!chart_plot(csv, scenes[i].name, options->folder, error)) return false;
        printf("%s: %d methods and settings, %d launches -> %s/chart-%s.png, .svg, .pdf\n", scenes[i].name,
               scenes[i].contenders, scenes[i].launches, options->folder, scenes[i].name);
        const char *without = scenes[i].without_network.text;
        if (without[0] != '\0') printf("    left out, as no network is named for them: %s\n", without);
        /* Nothing was solved if an earlier run had scored everything. */
        if (scenes[i].solves == 0) continue;
        printf(
            "    reference: residual at most %.1g m/s in frozen steps; above 1 mm/s in %d of %d steps in closed loop\n",
            scenes[i].frozen_residual, scenes[i].unconverged, scenes[i].solves);
    }
    const NameList left_out = contenders_left_out(options->quick ? STUDY_CHART_QUICK : STUDY_CHART);
    if (options->methods == NULL && left_out.text[0] != '\0')
        printf("left out unless named in --methods: %s\n", left_out.text);
    return true;
}

int command_chart(int argc, char **argv, Error *error) {
    Options options = {0};
    options.study.scenes = options.scenes;
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    SpeedAccuracyScene scenes[STUDY_MAX_SCENES];
    Stages stages = {.begun = false};
    bool ok = speed_accuracy_run(&options.study, &(StageProgress){begin_stage, &stages}, scenes, error);
    end_stage(&stages);
    return ok && draw(&options.study, scenes, error) ? STATUS_SAME : STATUS_DIFFERENT;
}
