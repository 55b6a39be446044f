/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/installed.h"
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/file.h"
#include "common/standard_io.h"
#include "particles_training/gns_training.h"

#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 4096 };

typedef struct Options {
    GnsTraining training;
    const char *scenes;
} Options;

static const Option options[] = {
    {"--scenes", 0, "A,B", "Scenes whose launches are recorded", OPTION_TEXT(Options, scenes),
     .standard = "single,stack,pyramid,pyramid_settled"},
    {"--launches", 0, "N", "Launches recorded of each scene", OPTION_INT(Options, training.launches, 1, LAUNCHES_MAX),
     .standard = "24"},
    {"--width", 0, "N", "Hidden units of each layer: a multiple of 16",
     OPTION_INT(Options, training.width, GNS_WIDTH_STEP, GNS_MAX_WIDTH), .standard = "16"},
    {"--rounds", 0, "M", "Rounds of message passing", OPTION_INT(Options, training.rounds, 1, GNS_MAX_ROUNDS),
     .standard = "5"},
    {"--radius", 0, "R", "Particles nearer than R m exchange messages",
     OPTION_FLOAT(Options, training.radius, 0.01, 100), .standard = "0.6"},
    {"--noise", 0, "S", "Standard deviation of the noise on velocities, m/s",
     OPTION_FLOAT(Options, training.noise, 0, 10), .standard = "0.1"},
    {"--steps", 0, "N", "Gradient steps", OPTION_INT(Options, training.steps, 1, 100000000), .standard = "20000"},
    {"--batch", 0, "N", "Examples of a gradient step", OPTION_INT(Options, training.batch, 1, 1024), .standard = "8"},
    {"--rate", 0, "R", "Rate of the first step; it falls to 0", OPTION_DOUBLE(Options, training.rate, 1e-9, 1),
     .standard = "0.005"},
    {"--seed", 0, "N", "Seed of the examples and of the initial weights", OPTION_SEED(Options, training.seed),
     .standard = "1"},
    {0}};

static void print_score(void *context, const GnsScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%7d  %9.5f  %9.5f\n", score->steps, score->loss, score->held_out);
    fflush(stdout);
}

static void print_times(const GnsTraining *training) {
    const double paper = GNS_PAPER_STEPS * GNS_PAPER_BATCH / training->batch;
    if (training->seconds_a_step > 0)
        printf("%.3g ms a gradient step of %d examples; the paper's %.0f million examples would take %.3g hours\n",
               1e3 * training->seconds_a_step, training->batch, 1e-6 * GNS_PAPER_STEPS * GNS_PAPER_BATCH,
               paper * training->seconds_a_step / 3600);
    printf("%.3g ms a simulation step of %d boxes\n", 1e3 * training->seconds_a_pass, training->pass_boxes);
}

/* Reads the scenes of a list; their number in *count. */
static bool read_scenes(const char *list, Scene *scenes[GNS_MAX_SCENES], int *count, Error *error) {
    char names[PATH_SIZE];
    *count = 0;
    if (strlen(list) >= sizeof names) return error_input(error, "--scenes", "the list is too long");
    strcpy(names, list);
    for (char *rest = names, *name; (name = strtok_r(rest, ",", &rest)) != NULL;) {
        if (*count == GNS_MAX_SCENES)
            return error_input(error, "--scenes", "at most %d scenes can be given", GNS_MAX_SCENES);
        scenes[*count] = scene_read(installed_path(name), error);
        if (scenes[*count] == NULL) return false;
        ++*count;
    }
    return *count > 0 || error_input(error, "--scenes", "no scene is given");
}

static bool store(const GnsNet *net, const TrainRequest *request, const char *state, const GnsTraining *training,
                  Error *error) {
    if (!gns_net_write(net, request->output, error) || !file_remove(state, error)) return false;
    print_times(training);
    printf("%d parameters -> %s\n", net->layout.parameters, request->output);
    return true;
}

static bool train(const TrainRequest *request, Options *given, Error *error) {
    GnsTraining *training = &given->training;
    Scene *scenes[GNS_MAX_SCENES];
    GnsNet net;
    char command[GNS_COMMAND_SIZE], state[PATH_SIZE];
    if (!file_path(state, sizeof state, error, "%s.part", request->output)) return false;
    if (!read_scenes(given->scenes, scenes, &training->scene_count, error)) {
        for (int i = 0; i < training->scene_count; i++) scene_destroy(scenes[i]);
        return false;
    }
    train_describe(request, command, sizeof command);
    training->command = command;
    training->state_path = state;
    training->scenes = scenes;
    training->on_score = print_score;
    printf("mean squared error of accelerations, in units of their deviation\n  steps       loss   held out\n");
    bool ok = gns_training_run(training, &net, progress_bar_begin("training"), error);
    progress_bar_end();
    snprintf(net.command, sizeof net.command, "%s", command);
    ok = ok && store(&net, request, state, training, error);
    gns_net_free(&net);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Options given = {.scenes = NULL};
    if (path_is_standard(request->output))
        return error_input(error, "-o", "gns keeps its state beside the network; give the network a name");
    if (!train_read(request, &given, error)) return false;
    if (given.training.width % GNS_WIDTH_STEP != 0)
        return error_input(error, "--width", "%d is not a multiple of %d", given.training.width, GNS_WIDTH_STEP);
    return train(request, &given, error);
}

const TrainKind train_gns = {
    "gns",
    NULL,
    "the graph network of gns, on steps of recorded launches. Prints its error during the "
    "training, and at the end what a step costs. An interrupted training is resumed by the same "
    "command; its state is in NET.npz.part",
    "gns",
    options,
    run};
