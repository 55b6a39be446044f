/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/train_scene_net.h"

#include "cli/options.h"
#include "cli/progress_bar.h"
#include "impact_training/scene_training.h"

#include <stdio.h>
#include <string.h>

/* What the scores are told to. */
typedef struct Listener {
    ProgressBar bar;
    SceneNetScore last;
} Listener;

static void print_score(void *context, const SceneNetScore *score) {
    Listener *listener = context;
    listener->last = *score;
    progress_bar_clear(&listener->bar);
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

static bool store(SlotNetwork *network, const TrainSceneNet *options, int width, Error *error) {
    snprintf(network->command, sizeof network->command,
             "twinbox train --kind scene-net %s -o %s --launches %s --rounds %s --iterations %s --width %d --sweeps %s "
             "--momentum %s --seed %s",
             options->scene, options->output, options->launches, options->rounds, options->iterations, width,
             options->sweeps, options->momentum, options->seed);
    if (!slot_network_write(network, options->output, error)) return false;
    printf("%s%d slots, %zu parameters -> %s\n", progress_interrupted() ? "stopped early; " : "", network->slot_count,
           network->parameter_count, options->output);
    return true;
}

static SlotNetwork *train(const Scene *scene, SceneTraining *training, SceneNetScore *score, Error *error) {
    Listener listener = {.last = {0}};
    progress_bar_begin(&listener.bar, "training");
    training->context = &listener;
    printf("%d wide; mean velocity error, m/s\nround  samples     train  held out  momentum 20\n",
           training->widths.hidden);
    SlotNetwork *network = scene_training_run(scene, training, &listener.bar.progress, error);
    progress_bar_end(&listener.bar);
    *score = listener.last;
    return network;
}

/* Tries one width after the other. NULL without an error: the sweeps alone are good enough. */
static SlotNetwork *train_smallest(const Scene *scene, SceneTraining *training, double within, Error *error) {
    static const int widths[] = {16, 32, 48, 64, 96, 128, 192, 256};
    SceneNetScore score = {0};
    for (size_t i = 0; i < sizeof widths / sizeof widths[0]; i++) {
        training->widths.hidden = widths[i];
        SlotNetwork *network = train(scene, training, &score, error);
        if (network == NULL) return NULL;
        const bool none = score.momentum <= within;
        if (none) printf("no network is needed: momentum with 20 sweeps is within %g m/s\n", within);
        if (!none && (score.held_out <= within || progress_interrupted())) return network;
        slot_network_destroy(network);
        if (none) return NULL;
    }
    error_input(error, "--within", "no network up to 256 wide comes within %g m/s; the last has %.4f", within,
                score.held_out);
    return NULL;
}

static bool train_and_store(const Scene *scene, const TrainSceneNet *options, SceneTraining *training, Error *error) {
    float within = 0;
    if (options->smallest != (options->within != NULL))
        return error_input(error, "--smallest", "goes with --within E, and that with it");
    if (options->smallest && !option_float("--within", options->within, 0, 1000, &within, error)) return false;
    SceneNetScore score;
    SlotNetwork *network = options->smallest ? train_smallest(scene, training, (double)within, error)
                                             : train(scene, training, &score, error);
    bool ok = network != NULL ? store(network, options, training->widths.hidden, error) : error->kind == ERROR_NONE;
    slot_network_destroy(network);
    return ok;
}

bool train_scene_net(const TrainSceneNet *options, Error *error) {
    SceneTraining training = {.widths = {.state = 16, .present = 32, .warm = 16}, .on_score = print_score};
    if (!parse(options, &training, error)) return false;
    Scene *scene = scene_read(options->scene, error);
    bool ok = scene != NULL && train_and_store(scene, options, &training, error);
    scene_destroy(scene);
    return ok;
}
