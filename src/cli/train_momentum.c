/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/train_momentum.h"
#include "impact_training/momentum_fit.h"

#include <stdio.h>

static void print_schedule(void *context, int sweeps, double plain, double by_hand, double learned) {
    progress_bar_clear(context);
    printf("%6d  %11.4f  %11.4f  %11.4f\n", sweeps, plain, by_hand, learned);
    fflush(stdout);
}

static bool fit_and_store(const Scene *scene, const TrainMomentum *options, Error *error) {
    MomentumFitOptions fit = {.on_schedule = print_schedule};
    if (!option_range("--bomb-x", options->bomb_x, &fit.bomb_x, error) ||
        !option_int("--iterations", options->iterations, 0, 100000, &fit.generations, error) ||
        !option_seed("--seed", options->seed, &fit.seed, error))
        return false;
    ProgressBar bar;
    progress_bar_begin(&bar, "fitting");
    fit.context = &bar;
    printf("error in m/s, at impact plus after\nsweeps        plain      by hand      learned\n");
    MomentumSchedules schedules;
    bool ok = momentum_fit(&schedules, scene, &fit, &bar.progress, error);
    progress_bar_end(&bar);
    if (!ok) return false;
    snprintf(schedules.command, sizeof schedules.command,
             "twinbox train --kind momentum-schedule %s -o %s --iterations %s --seed %s --bomb-x=%s", options->scene,
             options->output, options->iterations, options->seed, options->bomb_x);
    ok = momentum_schedules_write(&schedules, options->output, error);
    if (ok) printf("%s-> %s\n", progress_interrupted() ? "stopped early " : "", options->output);
    momentum_schedules_free(&schedules);
    return ok;
}

bool train_momentum(const TrainMomentum *options, Error *error) {
    Scene *scene = scene_read(options->scene, error);
    bool ok = scene != NULL && fit_and_store(scene, options, error);
    scene_destroy(scene);
    return ok;
}
