/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/standard_io.h"
#include "common/file.h"
#include "interior_training/first_round.h"

#include <stdio.h>

enum { PATH_SIZE = 4096 };

static const Option options[] = {
    {"--scenes", 0, "N", "Random scenes of each round", OPTION_INT(NetTraining, scenes, 7, 100000), .standard = "300"},
    {"--rounds", 0, "N", "Rounds; the scenes of the first are run without the network, those of the others with it",
     OPTION_INT(NetTraining, rounds, 1, NET_ROUNDS_MAX), .standard = "3"},
    {"--epochs", 0, "N", "Epochs of each round", OPTION_INT(NetTraining, epochs, 1, 100000), .standard = "20"},
    {"--seed", 0, "N", "Seed of the scenes and of the initial weights", OPTION_SEED(NetTraining, seed),
     .standard = "1"},
    {TRAIN_SHARD},
    {0}};

static void print_score(void *context, const NetScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%5d  %8d  %7.4f ", score->round, score->problems, score->loss);
    for (int k = 2; k <= 4; k += 2)
        printf("  %.4f (%.4f)  %.4f (%.4f)", score->with.mean[k], score->without.mean[k], score->with.percentile95[k],
               score->without.percentile95[k]);
    putchar('\n');
    fflush(stdout);
}

static bool train(const TrainRequest *request, const NetTraining *training, Error *error) {
    InteriorNet net;
    printf("held-out impacts, velocity error in m/s after 3 and 5 iterations, without the network in brackets\n"
           "round  problems     loss   mean             95%%              mean             95%%\n");
    bool ok = net_training_run(training, &net, progress_bar_begin("training"), error);
    progress_bar_end();
    snprintf(net.command, sizeof net.command, "%s", training->command);
    ok = ok && interior_net_write(&net, request->output, error) && file_remove(training->state_path, error);
    if (ok) printf("%d weights -> %s\n", INTERIOR_NET_WEIGHTS, request->output);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    NetTraining training = {.on_score = print_score};
    FirstRound first_round;
    Pieces pieces = {0};
    char command[sizeof((InteriorNet *)NULL)->command], state[PATH_SIZE];
    if (path_is_standard(request->output))
        return error_input(error, "-o", "interior-net keeps its state beside the network; give the network a name");
    if (!train_read(request, &training, error) || !file_path(state, sizeof state, error, "%s.part", request->output))
        return false;
    train_describe(request, command, sizeof command);
    training.command = command;
    training.state_path = state;
    first_round_make(&first_round, &training);
    bool ok = train_pieces(request, &first_round.plan, &pieces, error);
    if (ok && pieces.mode == PIECES_MERGE) training.recorded = &pieces;
    if (ok && pieces.mode != PIECES_SHARD) ok = train(request, &training, error);
    pieces_close(&pieces);
    return ok;
}

const TrainKind train_interior_net = {"interior-net",
                                      NULL,
                                      "the network of interior-net, on random scenes. Prints held-out errors after "
                                      "each round. An interrupted training is "
                                      "resumed by the same command; its state is in NET.npz.part",
                                      "interior-net",
                                      options,
                                      run};
