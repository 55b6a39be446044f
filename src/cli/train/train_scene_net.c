/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "impact_training/scene_recording.h"

#include <stdio.h>
#include <string.h>

typedef struct Options {
    SceneTraining training;
    SceneNetVerdict verdict;
    bool smallest;
    double within; /* m/s; negative: not given */
} Options;

static OptionRead read_momentum;

static const Option options[] = {
    {"--launches", 0, "N", "Launches of each round; half of them rotated and spinning",
     OPTION_INT(Options, training.launches, 10, 100000), .standard = "3000"},
    {"--rounds", 0, "N", "Rounds; the first runs the launches without the network, the others with it",
     OPTION_INT(Options, training.rounds, 1, 100), .standard = "3"},
    {"--iterations", 0, "N", "Epochs of the first round; the others have half as many",
     OPTION_INT(Options, training.epochs, 1, 100000), .standard = "40"},
    {"--width", 0, "N", "Width of both hidden layers, a multiple of 16",
     OPTION_INT(Options, training.widths.hidden, ROW_LANES, SLOT_WIDTH_MAX), .standard = "64"},
    {"--sweeps", 0, "K", "Sweeps that follow the network", OPTION_INT(Options, training.sweeps, 1, SLOT_SWEEPS_MAX),
     .standard = "14"},
    {"--momentum", 0, "on|off", "Whether the sweeps after the network have learned momentum factors",
     OPTION_READ(read_momentum, Options, training.momentum), .standard = "on"},
    {"--seed", 0, "N", "Seed of the initial weights and of the launches", OPTION_SEED(Options, training.seed),
     .standard = "1"},
    {"--smallest", 0, NULL, "Train the smallest width whose held-out error is at most that of --within",
     OPTION_FLAG(Options, smallest)},
    {"--within", 0, "E", "Held-out error to reach, m/s; only with --smallest", OPTION_DOUBLE(Options, within, 0, 1000)},
    {TRAIN_SHARD},
    {0}};

static bool read_momentum(const Option *option, const char *text, void *value, Error *error) {
    const bool on = *(bool *)value = strcmp(text, "on") == 0;
    return on || strcmp(text, "off") == 0 || error_input(error, option->name, "'%s' is neither on nor off", text);
}

/* Context: the last score. */
static void print_score(void *context, const SceneNetScore *score) {
    *(SceneNetScore *)context = *score;
    progress_bar_clear();
    printf("%5d  %7d  %8.4f  %8.4f  %11.4f\n", score->round, score->samples, score->train, score->held_out,
           score->momentum);
    fflush(stdout);
}

/* The stored command trains the width that was found. */
static bool store(SlotNetwork *network, const TrainRequest *request, int width, Error *error) {
    TrainRequest found = *request;
    char text[16];
    snprintf(text, sizeof text, "%d", width);
    train_set(&found, "--width", text);
    train_set(&found, "--smallest", NULL);
    train_set(&found, "--within", NULL);
    train_describe(&found, network->command, sizeof network->command);
    if (!slot_network_write(network, request->output, error)) return false;
    printf("%s%d slots, %zu parameters -> %s\n", interrupt_requested() ? "stopped early; " : "", network->slot_count,
           network->parameter_count, request->output);
    return true;
}

static const char *compare(double error, double rival) {
    return error < rival ? "better than" : error > rival ? "worse than" : "as good as";
}

/* Of the last round; absent without held-out impacts. */
static void print_verdict(const SceneNetVerdict *verdict) {
    if (verdict->samples == 0) {
        printf("verdict: none, as no held-out launch has an impact\n");
        return;
    }
    printf("held out: the network and its sweeps %.4f m/s in %.3g us; momentum in that time, %d sweeps, %.4f; with 20 "
           "sweeps %.4f\n",
           verdict->network, verdict->microseconds, verdict->sweeps, verdict->at_equal_time, verdict->at_20);
    printf("verdict: %s momentum at equal time; %s momentum with 20 sweeps\n",
           compare(verdict->network, verdict->at_equal_time), compare(verdict->network, verdict->at_20));
}

static SlotNetwork *train(const Scene *scene, SceneTraining *training, SceneNetScore *score, Error *error) {
    *score = (SceneNetScore){0};
    training->context = score;
    printf("%d wide; mean velocity error, m/s\nround  samples     train  held out  momentum 20\n",
           training->widths.hidden);
    SlotNetwork *network = scene_training_run(scene, training, progress_bar_begin("training"), error);
    progress_bar_end();
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
        if (!none && (score.held_out <= within || interrupt_requested())) return network;
        slot_network_destroy(network);
        if (none) return NULL;
    }
    error_input(error, "--within", "no network up to 256 wide comes within %g m/s; the last has %.4f", within,
                score.held_out);
    return NULL;
}

static bool train_and_store(const Scene *scene, const TrainRequest *request, Options *given, Error *error) {
    SceneTraining *training = &given->training;
    SceneNetScore score;
    SlotNetwork *network =
        given->smallest ? train_smallest(scene, training, given->within, error) : train(scene, training, &score, error);
    bool ok = network != NULL ? store(network, request, training->widths.hidden, error) : error->kind == ERROR_NONE;
    if (ok && network != NULL) print_verdict(&given->verdict);
    slot_network_destroy(network);
    return ok;
}

/* A shard records and does not train; every width that a merge trains reads the same records. */
static bool record_or_train(const Scene *scene, const TrainRequest *request, Options *given, Error *error) {
    SceneRecording recording;
    Pieces pieces = {0};
    bool ok = scene_recording_begin(&recording, scene, &given->training, error) &&
              train_pieces(request, &recording.plan, &pieces, error);
    if (ok && pieces.mode == PIECES_MERGE) given->training.recorded = &pieces;
    if (ok && pieces.mode != PIECES_SHARD) ok = train_and_store(scene, request, given, error);
    pieces_close(&pieces);
    scene_recording_end(&recording);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Options given = {.training = {.widths = {.state = 16, .present = 32, .warm = 16}, .on_score = print_score},
                     .within = -1};
    if (!train_read(request, &given, error)) return false;
    given.training.verdict = &given.verdict;
    const int width = given.training.widths.hidden;
    if (width % ROW_LANES != 0) return error_input(error, "--width", "%d is not a multiple of %d", width, ROW_LANES);
    if (given.smallest != (given.within >= 0))
        return error_input(error, "--smallest", "goes with --within E, and that with it");
    Scene *scene = scene_read(request->input, error);
    bool ok = scene != NULL && record_or_train(scene, request, &given, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_scene_net = {
    "scene-net",
    "SCENE",
    "a network for the impacts of a scene. Prints its mean velocity error after each round, on the training and the "
    "held-out launches, beside that of 20 sweeps with momentum",
    "scene-net",
    options,
    run};
