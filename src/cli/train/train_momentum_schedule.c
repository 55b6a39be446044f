/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "impact_training/momentum_fit.h"

#include <stdio.h>

static const Option options[] = {
    {"--iterations", 0, "N", "Generations of CMA-ES for each number of sweeps",
     OPTION_INT(MomentumFitOptions, generations, 0, 100000), .standard = "100"},
    {"--seed", 0, "N", "Seed of the search", OPTION_SEED(MomentumFitOptions, seed), .standard = "1"},
    {"--bomb-x", 0, "A:B:STEP", "Launches that the factors are fitted to, m", OPTION_RANGE(MomentumFitOptions, bomb_x),
     .standard = "-5:5:0.5"},
    {0}};

static void print_schedule(void *context, int sweeps, double without, double tuned, double learned) {
    (void)context;
    progress_bar_clear();
    printf("%6d  %11.4f  %11.4f  %11.4f\n", sweeps, without, tuned, learned);
    fflush(stdout);
}

static bool fit_and_store(const Scene *scene, const TrainRequest *request, Error *error) {
    MomentumFitOptions fit = {.on_schedule = print_schedule};
    if (!train_read(request, &fit, error)) return false;
    printf("error in m/s, at impact plus after\nsweeps  no momentum   hand-tuned      learned\n");
    MomentumSchedules schedules;
    bool ok = momentum_fit(&schedules, scene, &fit, progress_bar_begin("fitting"), error);
    progress_bar_end();
    if (!ok) return false;
    train_describe(request, schedules.command, sizeof schedules.command);
    ok = momentum_schedules_write(&schedules, request->output, error);
    if (ok) printf("%s-> %s\n", interrupt_requested() ? "stopped early " : "", request->output);
    momentum_schedules_free(&schedules);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Scene *scene = scene_read(request->input, error);
    bool ok = scene != NULL && fit_and_store(scene, request, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_momentum_schedule = {"momentum-schedule",
                                           "SCENE",
                                           "the factors of learned-momentum for a scene, by CMA-ES. Prints the error "
                                           "of sweeps without momentum, with hand-tuned "
                                           "factors and with the learned ones",
                                           "momentum-schedules",
                                           options,
                                           run};
