/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/train_scene_net.h"

#include "cli/options.h"
#include "cli/progress_bar.h"
#include "training/scene_training.h"

#include <stdio.h>
#include <string.h>

static void print_score(void *context, const SceneScore *score) {
    progress_bar_clear(context);
    printf("%5d  %7d  %8.4f  %8.4f  %11.4f\n", score->round, score->samples, score->train, score->held_out,
           score->momentum);
    fflush(stdout);
}

static bool parse(const TrainSceneNet *options, SceneTraining *training, Error *error) {
    if (!option_int("--launches", options->launches, 10, 100000, &training->launches, error) ||
        !option_int("--rounds", options->rounds, 1, 100, &training->rounds, error) ||
        !option_int("--iterations", options->iterations, 1, 100000, &training->epochs, error) ||
        !option_int("--sweeps", options->sweeps, 1, SLOT_SWEEPS_MAX, &training->sweeps, error) ||
        !option_int("--width", options->width, ROW_LANES, SLOT_WIDTH_MAX, &training->widths.hidden, error) ||
        !option_seed("--seed", options->seed, &training->seed, error))
        return false;
    training->momentum = strcmp(options->momentum, "on") == 0;
    if (!training->momentum && strcmp(options->momentum, "off") != 0)
        return error_input(error, "--momentum", "'%s' is neither on nor off", options->momentum);
    if (training->widths.hidden % ROW_LANES == 0) return true;
    return error_input(error, "--width", "%d is no multiple of %d", training->widths.hidden, ROW_LANES);
}

static bool store(SlotNetwork *network, const TrainSceneNet *options, Error *error) {
    snprintf(network->command, sizeof network->command,
             "twinbox train --kind scene-net %s -o %s --launches %s --rounds %s --iterations %s --width %s --sweeps %s "
             "--momentum %s --seed %s",
             options->scene, options->output, options->launches, options->rounds, options->iterations, options->width,
             options->sweeps, options->momentum, options->seed);
    if (!slot_network_write(network, options->output, error)) return false;
    printf("%s%d slots, %zu parameters -> %s\n", progress_interrupted() ? "stopped early; " : "", network->slot_count,
           network->parameter_count, options->output);
    return true;
}

bool train_scene_net(const TrainSceneNet *options, Error *error) {
    SceneTraining training = {.widths = {.state = 32, .present = 48, .warm = 16}, .on_score = print_score};
    if (!parse(options, &training, error)) return false;
    Scene *scene = scene_read(options->scene, error);
    if (scene == NULL) return false;
    ProgressBar bar;
    progress_bar_begin(&bar, "training");
    training.context = &bar;
    printf("mean velocity error, m/s\nround  samples     train  held out  momentum 20\n");
    SlotNetwork *network = scene_training_run(scene, &training, &bar.progress, error);
    progress_bar_end(&bar);
    scene_destroy(scene);
    bool ok = network != NULL && store(network, options, error);
    slot_network_destroy(network);
    return ok;
}
