/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "common/file.h"
#include "paper/figures/illustrations.h"
#include "paper/figures/plots.h"
#include "paper/report/paper_report.h"
#include "paper/study/paper.h"

#include <stdio.h>

enum { SCENES = 256, QUICK, SEED };

static const struct argp_option option_table[] = {
    {"output", 'o', "DIR", 0, "Folder for tables, figures, networks and the report", 0},
    {"scenes", SCENES, "DIR", 0,
     "Folder with single.yaml, stack.yaml, pyramid.yaml and pyramid_settled.yaml (default: scenes, or the installed "
     "scenes)",
     0},
    {"quick", QUICK, NULL, 0, "Fewer networks, launches and iterations: under a minute", 0},
    {"seed", SEED, "N", 0, "Seed of launches, splits and initial weights (default: 1)", 0},
    {0}};

typedef struct Options {
    PaperOptions study;
    const char *seed;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->study.folder = value; break;
    case SCENES: options->study.scenes = value; break;
    case QUICK: options->study.quick = true; break;
    case SEED: options->seed = value; break;
    case ARGP_KEY_ARG: argp_error(state, "'%s' is not expected", value); break;
    case ARGP_KEY_END:
        if (options->study.folder == NULL) argp_error(state, "-o DIR is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "",
    "Reproduce the paper (Avatavului, Ifrim, Voncila 2023) from seed to report: train its networks in every reading, "
    "one factor at a time, rate them, replace the solver by them, and try what the paper leaves to future work. "
    "Writes report.md, report.html, every table as CSV, and every figure as PNG and SVG. Takes about ten minutes on "
    "two cores. An interrupted run continues where it stopped.\v"
    "Example: twinbox paper -o out/paper\n"
    "         twinbox paper -o out/paper-quick --quick",
    NULL,
    NULL,
    NULL};

static bool draw_and_report(const PaperOptions *study, Error *error) {
    enum { PATH_SIZE = 4096 };
    char figures[PATH_SIZE];
    if (!file_path(figures, sizeof figures, error, "%s/figures", study->folder)) return false;
    if (!file_make_directory(figures, error) || !illustrations_draw(study->scenes, figures, error) ||
        !plots_draw(study->folder, error) || !paper_report_write(study->folder, error))
        return false;
    printf("tables, figures, networks -> %s\nreport -> %s/report.md, %s/report.html\n", study->folder, study->folder,
           study->folder);
    return true;
}

int command_paper(int argc, char **argv, Error *error) {
    Options options = {.study = {.scenes = installed_path("scenes")}, .seed = "1"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    if (!option_seed("--seed", options.seed, &options.study.seed, error)) return STATUS_DIFFERENT;
    ProgressBar bar;
    progress_bar_begin(&bar, "paper");
    bool ok = paper_run(&options.study, &bar.progress, error);
    progress_bar_end(&bar);
    return ok && draw_and_report(&options.study, error) ? STATUS_SAME : STATUS_DIFFERENT;
}
