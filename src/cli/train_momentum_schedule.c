/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/train.h"
#include "impact_training/momentum_fit.h"

#include <stdio.h>

static const TrainOption options[] = {{"iterations", "N", "100", "Generations of CMA-ES for each number of sweeps"},
                                      {"seed", "N", "1", "Seed of the search"},
                                      {"bomb-x", "A:B:STEP", "-5:5:0.5", "Launches that the factors are fitted to, m"},
                                      {NULL, NULL, NULL, NULL}};

static void print_schedule(void *context, int sweeps, double without, double tuned, double learned) {
    progress_bar_clear(context);
    printf("%6d  %11.4f  %11.4f  %11.4f\n", sweeps, without, tuned, learned);
    fflush(stdout);
}

static bool fit_and_store(const Scene *scene, const TrainRequest *request, Error *error) {
    MomentumFitOptions fit = {.on_schedule = print_schedule};
    if (!option_range("--bomb-x", train_value(request, "bomb-x"), &fit.bomb_x, error) ||
        !option_int("--iterations", train_value(request, "iterations"), 0, 100000, &fit.generations, error) ||
        !option_seed("--seed", train_value(request, "seed"), &fit.seed, error))
        return false;
    ProgressBar bar;
    progress_bar_begin(&bar, "fitting");
    fit.context = &bar;
    printf("error in m/s, at impact plus after\nsweeps  no momentum   hand-tuned      learned\n");
    MomentumSchedules schedules;
    bool ok = momentum_fit(&schedules, scene, &fit, &bar.progress, error);
    progress_bar_end(&bar);
    if (!ok) return false;
    train_describe(request, schedules.command, sizeof schedules.command);
    ok = momentum_schedules_write(&schedules, request->output, error);
    if (ok) printf("%s-> %s\n", progress_interrupted() ? "stopped early " : "", request->output);
    momentum_schedules_free(&schedules);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Scene *scene = scene_read(request->input, error);
    bool ok = scene != NULL && fit_and_store(scene, request, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_momentum_schedule = {"momentum-schedule", "SCENE",
                                           "the factors of learned-momentum for a scene, by CMA-ES. Prints the error "
                                           "of sweeps without momentum, with hand-tuned "
                                           "factors and with the learned ones",
                                           options, run};
