/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/train.h"
#include "impact_training/scene_training.h"

#include <stdio.h>
#include <string.h>

static const TrainOption options[] = {
    {"launches", "N", "3000", "Launches of each round; half of them rotated and spinning"},
    {"rounds", "N", "3", "Rounds; the first runs the launches without the network, the others with it"},
    {"iterations", "N", "40", "Epochs of the first round; the others have half as many"},
    {"width", "N", "64", "Width of both hidden layers, a multiple of 16"},
    {"sweeps", "K", "14", "Sweeps that follow the network"},
    {"momentum", "on|off", "on", "Whether the sweeps after the network have learned momentum factors"},
    {"seed", "N", "1", "Seed of the initial weights and of the launches"},
    {"smallest", NULL, NULL, "Train the smallest width whose held-out error is at most that of --within"},
    {"within", "E", NULL, "Held-out error to reach, m/s; only with --smallest"},
    {NULL, NULL, NULL, NULL}};

/* The context of print_score. */
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

static bool parse(const TrainRequest *request, SceneTraining *training, Error *error) {
    const char *momentum = train_value(request, "momentum");
    if (!option_int("--launches", train_value(request, "launches"), 10, 100000, &training->launches, error) ||
        !option_int("--rounds", train_value(request, "rounds"), 1, 100, &training->rounds, error) ||
        !option_int("--iterations", train_value(request, "iterations"), 1, 100000, &training->epochs, error) ||
        !option_int("--sweeps", train_value(request, "sweeps"), 1, SLOT_SWEEPS_MAX, &training->sweeps, error) ||
        !option_int("--width", train_value(request, "width"), ROW_LANES, SLOT_WIDTH_MAX, &training->widths.hidden,
                    error) ||
        !option_seed("--seed", train_value(request, "seed"), &training->seed, error))
        return false;
    training->momentum = strcmp(momentum, "on") == 0;
    if (!training->momentum && strcmp(momentum, "off") != 0)
        return error_input(error, "--momentum", "'%s' is neither on nor off", momentum);
    if (training->widths.hidden % ROW_LANES == 0) return true;
    return error_input(error, "--width", "%d is not a multiple of %d", training->widths.hidden, ROW_LANES);
}

/* The stored command trains the width that was found. */
static bool store(SlotNetwork *network, const TrainRequest *request, int width, Error *error) {
    TrainRequest found = *request;
    char text[16];
    snprintf(text, sizeof text, "%d", width);
    train_set(&found, "width", text);
    train_set(&found, "smallest", NULL);
    train_set(&found, "within", NULL);
    train_describe(&found, network->command, sizeof network->command);
    if (!slot_network_write(network, request->output, error)) return false;
    printf("%s%d slots, %zu parameters -> %s\n", progress_interrupted() ? "stopped early; " : "", network->slot_count,
           network->parameter_count, request->output);
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

static bool train_and_store(const Scene *scene, const TrainRequest *request, SceneTraining *training, Error *error) {
    const bool smallest = train_value(request, "smallest") != NULL;
    const char *text = train_value(request, "within");
    float within = 0;
    if (smallest != (text != NULL)) return error_input(error, "--smallest", "goes with --within E, and that with it");
    if (smallest && !option_float("--within", text, 0, 1000, &within, error)) return false;
    SceneNetScore score;
    SlotNetwork *network =
        smallest ? train_smallest(scene, training, (double)within, error) : train(scene, training, &score, error);
    bool ok = network != NULL ? store(network, request, training->widths.hidden, error) : error->kind == ERROR_NONE;
    slot_network_destroy(network);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    SceneTraining training = {.widths = {.state = 16, .present = 32, .warm = 16}, .on_score = print_score};
    if (!parse(request, &training, error)) return false;
    Scene *scene = scene_read(request->input, error);
    bool ok = scene != NULL && train_and_store(scene, request, &training, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_scene_net = {
    "scene-net", "SCENE",
    "a network for the impacts of a scene. Prints its mean velocity error after each round, on the training and the "
    "held-out launches, beside that of 20 sweeps with momentum",
    options, run};
