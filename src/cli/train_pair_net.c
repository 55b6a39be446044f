/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/train.h"
#include "training/training.h"

#include <stdio.h>
#include <string.h>

static const TrainOption options[] = {
    {"layers", "WIDTHS", "10-10-2",
     "Widths of the layers. 10-10-2: change of relative velocity, min-max outputs, as in the paper's 3.2. With two "
     "hidden "
     "layers and all six changes: 10-8-8-6, standardised outputs, as in its 3.1"},
    {"optimizer", "NAME", "adam", "adam, bfgs, gd (gradient descent) or lm (Levenberg-Marquardt)"},
    {"iterations", "N", "2000", "Full-batch steps"},
    {"seed", "N", "1", "Seed of the initial weights"},
    {"from", "NET.npz", NULL, "Continue from the weights of this network, such as one cut short by Ctrl-C"},
    {"hidden", "NAME", NULL, "Activation of the hidden layers: sigmoid (default), tanh or relu"},
    {"output-activation", "NAME", NULL, "sigmoid or linear (default: sigmoid for two outputs, linear for six)"},
    {"scale", "NAME", NULL,
     "Scale of the outputs: minmax or, with linear outputs, standard (default: minmax with sigmoid, standard with "
     "linear)"},
    {"loss", "NAME", NULL,
     "Loss of the outputs: mse (default), or smooth-l1, which is linear beyond 0.3 m/s, so that rare impacts weigh "
     "less"},
    {"laws", "NAME=W,...", NULL,
     "Weights of physical laws in the loss of six outputs: momentum, energy, approach, cone. Needs a dataset recorded "
     "with --context"},
    {NULL, NULL, NULL, NULL}};

/* "10-10-2" -> widths; a layer of weights lies between two of them. */
static bool parse_layers(const char *text, TrainingOptions *training, Error *error) {
    int count = 0;
    for (const char *rest = text; count <= NETWORK_MAX_LAYERS; rest++) {
        size_t length = strcspn(rest, "-");
        char width[16] = "";
        int64_t value;
        if (length < sizeof width) memcpy(width, rest, length);
        if (!parse_int(width, 1, NETWORK_MAX_WIDTH, &value)) break;
        training->widths[count++] = (int)value;
        rest += length;
        if (*rest != '\0') continue;
        training->layers = count - 1;
        if (count >= 2) return true;
        break;
    }
    return error_input(error, "--layers", "'%s' is not 2 to %d widths from 1 to %d, such as 10-10-2", text,
                       NETWORK_MAX_LAYERS + 1, NETWORK_MAX_WIDTH);
}

static void print_score(void *context, const TrainingScore *score) {
    ProgressBar *bar = context;
    progress_bar_clear(bar);
    printf("%9d  %10.6f  %10.6f  %13.6f  %14.6f\n", score->iteration, score->test, score->train, score->constant_test,
           score->constant_train);
    fflush(stdout);
}

static Network *train(const Dataset *dataset, TrainingOptions *training, Error *error) {
    ProgressBar bar;
    progress_bar_begin(&bar, "training");
    training->on_score = print_score;
    training->context = &bar;
    printf("iteration   test score  train score  constant test  constant train\n");
    Network *network = training_run(dataset, training, &bar.progress, error);
    progress_bar_end(&bar);
    return network;
}

static bool train_and_store(const Dataset *dataset, const TrainRequest *request, TrainingOptions *training,
                            Error *error) {
    Network *network = train(dataset, training, error);
    bool ok = network != NULL;
    if (ok) {
        train_describe(request, network->command, sizeof network->command);
        ok = network_write(network, request->output, error);
    }
    if (ok)
        printf("%s%d parameters -> %s\n", progress_interrupted() ? "stopped early; " : "",
               network_parameter_count(network), request->output);
    network_destroy(network);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    const char *laws = train_value(request, "laws"), *from = train_value(request, "from");
    TrainingOptions training = {.optimizer = train_value(request, "optimizer"),
                                .hidden = train_value(request, "hidden"),
                                .output_activation = train_value(request, "output-activation"),
                                .scale = train_value(request, "scale"),
                                .loss = train_value(request, "loss")};
    if (!parse_layers(train_value(request, "layers"), &training, error) ||
        !option_int("--iterations", train_value(request, "iterations"), 0, 1000000, &training.iterations, error) ||
        !option_seed("--seed", train_value(request, "seed"), &training.seed, error) ||
        (laws != NULL && !law_weights_parse(laws, &training.laws, error)))
        return false;
    Network *start = NULL;
    if (from != NULL && (start = network_read(from, error)) == NULL) return false;
    training.start = start;
    Dataset *dataset = dataset_read(request->input, error);
    bool ok = dataset != NULL && train_and_store(dataset, request, &training, error);
    dataset_destroy(dataset);
    network_destroy(start);
    return ok;
}

const TrainKind train_pair_net = {"pair-net", "DATA.npz",
                                  "a network of pairs of bodies, from a dataset. Prints its mean squared error as the "
                                  "paper's Table 1 does, beside that "
                                  "of always predicting the mean",
                                  options, run};
