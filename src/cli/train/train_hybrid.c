/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/file.h"
#include "common/standard_io.h"
#include "tabulation_training/tabulation_training.h"

#include <stdio.h>

enum { PATH_SIZE = 4096, MEBIBYTE = 1 << 20, REPORTS = 20 };

typedef struct Options {
    TabulationTraining training;
    double limit; /* MiB */
} Options;

static const Option options[] = {
    {"--launches", 0, "N", "Launches, one after the other",
     OPTION_INT(Options, training.launches, 1, TABULATION_LAUNCHES_MAX), .standard = "1000"},
    {"--steps", 0, "N", "Steps of each launch, from the bomb's first touch",
     OPTION_INT(Options, training.steps, 1, 100000), .standard = "66"},
    {"--tolerance", 0, "E", "RMS error of the velocities that answers may have, m/s",
     OPTION_FLOAT(Options, training.tolerance, 1e-6, 1000), .standard = "0.1"},
    {"--limit", 0, "MB", "Most MiB of the memory; when it is full, entries still grow",
     OPTION_DOUBLE(Options, limit, 0.001, 65536), .standard = "64"},
    {"--seed", 0, "N", "Seed of the launches", OPTION_SEED(Options, training.seed), .standard = "1"},
    {0}};

/* Sums over the launches since the last report. */
typedef struct Report {
    int launches;
    TabulationLaunch sum;
} Report;

static void print_report(Report *report, int number, const Tabulation *memory) {
    const TabulationLaunch *sum = &report->sum;
    progress_bar_clear();
    printf("%8d  %6d  %7.1f%%  %6d  %6d", number, sum->asked, sum->asked > 0 ? 100.0 * sum->answered / sum->asked : 0,
           sum->grown, sum->added);
    if (memory != NULL) printf("  %7d  %8.3f", memory->entry_count, (double)tabulation_bytes(memory) / MEBIBYTE);
    if (sum->checked > 0) printf("  %.4f", sum->error / sum->checked);
    printf("%s\n", sum->full > 0 ? "  full" : "");
    fflush(stdout);
    *report = (Report){.launches = report->launches};
}

static bool add_launch(void *context, const TabulationLaunch *launch, Error *error) {
    (void)error;
    Report *report = context;
    TabulationLaunch *sum = &report->sum;
    sum->asked += launch->asked;
    sum->answered += launch->answered;
    sum->grown += launch->grown;
    sum->added += launch->added;
    sum->full += launch->full;
    sum->checked += launch->checked;
    sum->error += launch->error;
    const int every = (report->launches + REPORTS - 1) / REPORTS;
    if (launch->number % every == 0 || launch->number == report->launches)
        print_report(report, launch->number, launch->memory);
    return true;
}

static bool learn(const Scene *scene, const TabulationTraining *training, const char *output, Error *error) {
    printf("launches   asked  answered   grown   added  entries       MiB  error of answers, m/s\n");
    Tabulation *memory = tabulation_training_run(scene, training, progress_bar_begin("learning"), error);
    progress_bar_end();
    bool ok = memory != NULL && tabulation_write(memory, output, error);
    if (ok && memory->launches == training->launches) ok = file_remove(training->state_path, error);
    if (ok)
        printf("%s%d entries of %d sets of contacts, from %d launches -> %s\n",
               interrupt_requested() ? "stopped early; " : "", memory->entry_count, memory->set_count, memory->launches,
               output);
    tabulation_destroy(memory);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Report report = {0};
    Options given = {.training = {.turned_from = -1,
                                  .components = TABULATION_STANDARD_COMPONENTS,
                                  .on_launch = add_launch,
                                  .context = &report}};
    char command[TABULATION_TEXT_SIZE], state[PATH_SIZE];
    if (path_is_standard(request->output))
        return error_input(error, "-o", "hybrid keeps its state beside the memory; give the memory a name");
    if (!train_read(request, &given, error) || !file_path(state, sizeof state, error, "%s.part", request->output))
        return false;
    train_describe(request, command, sizeof command);
    given.training.command = command;
    given.training.state_path = state;
    given.training.limit = (size_t)(given.limit * MEBIBYTE);
    report.launches = given.training.launches;
    Scene *scene = scene_read(request->input, error);
    const bool ok = scene != NULL && learn(scene, &given.training, request->output, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_hybrid = {"hybrid",
                                "SCENE",
                                "the memory of hybrid for a scene, launch after launch. Prints how many steps with an "
                                "impact it answered, and what it learned from the others. An interrupted training is "
                                "resumed by the same command; its state is in NET.npz.part",
                                "hybrid",
                                options,
                                run};
