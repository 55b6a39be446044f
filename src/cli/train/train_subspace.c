/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/file.h"
#include "common/standard_io.h"
#include "subspace_training/subspace_training.h"

#include <stdio.h>

enum { PATH_SIZE = 4096, EPOCH_BATCHES = 20 }; /* a second or so: what an interruption may lose */

static const Option options[] = {
    {"--launches", 0, "N", "Launches to learn from", OPTION_INT(SubspaceTraining, launches, 1, LAUNCHES_MAX),
     .standard = "201"},
    {"--epochs", 0, "N", "Epochs for each number of components, of 20 batches of 256 windows",
     OPTION_INT(SubspaceTraining, epochs, 1, 100000), .standard = "24"},
    {"--width", 0, "N", "Width of the two hidden layers, a multiple of 16",
     OPTION_INT(SubspaceTraining, hidden, ROW_LANES, SUBSPACE_HIDDEN_MAX), .standard = "64"},
    {"--seed", 0, "N", "Seed of windows and initial weights", OPTION_SEED(SubspaceTraining, seed), .standard = "1"},
    {0}};

static void print_score(void *context, const SubspaceScore *score, double loss) {
    (void)context;
    progress_bar_clear();
    printf("%10d  %8.4f  %8.4f %4.0f  %8.4f %4.0f  %8.4f %4.0f\n", score->components, loss, score->floor.rms,
           score->floor.frames, score->linear.rms, score->linear.frames, score->net.rms, score->net.frames);
    fflush(stdout);
}

static bool train_and_store(const Scene *scene, const TrainRequest *request, Error *error) {
    SubspaceTraining training = {.batches = EPOCH_BATCHES, .on_score = print_score};
    char command[SUBSPACE_TEXT_SIZE], state[PATH_SIZE];
    if (path_is_standard(request->output))
        return error_input(error, "-o", "subspace keeps its state beside the network; give the network a name");
    if (!train_read(request, &training, error) || !file_path(state, sizeof state, error, "%s.part", request->output))
        return false;
    if (training.hidden % ROW_LANES != 0)
        return error_input(error, "--width", "must be a multiple of %d (got %d)", ROW_LANES, training.hidden);
    train_describe(request, command, sizeof command);
    training.command = command;
    training.state_path = state;
    printf("held-out launches: distance from the recorded run, m (RMS over bodies and frames), and the median of the\n"
           "frames until a body is 0.1 m away\n"
           "components      loss  floor          linear term    with network\n");
    SubspaceNet *net = subspace_train(scene, &training, progress_bar_begin("training"), error);
    progress_bar_end();
    const bool ok = net != NULL && subspace_net_write(net, request->output, error) && file_remove(state, error);
    if (ok) printf("%d bodies -> %s\n", net->shape.bodies, request->output);
    subspace_net_destroy(net);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Scene *scene = scene_read(request->input, error);
    const bool ok = scene != NULL && train_and_store(scene, request, error);
    scene_destroy(scene);
    return ok;
}

const TrainKind train_subspace = {"subspace",
                                  "SCENE",
                                  "the networks of subspace for a scene, with 8, 32 and 128 principal components. "
                                  "Prints held-out errors of each. An interrupted training is resumed by the same "
                                  "command; its state is in NET.npz.part",
                                  SUBSPACE_KIND,
                                  options,
                                  run};
