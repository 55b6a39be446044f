/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/file.h"
#include "training/training.h"

#include <stdio.h>
#include <string.h>

typedef struct Options {
    TrainingOptions training;
    const char *from; /* NET.npz, or NULL */
} Options;

static OptionRead read_layers, read_laws;

static const Option options[] = {
    {"--layers", 0, "WIDTHS",
     "Widths of the layers. 10-10-2: change of relative velocity, min-max outputs, as in the paper's 3.2. With two "
     "hidden layers and all six changes: 10-8-8-6, standardised outputs, as in its 3.1",
     OPTION_READ(read_layers, Options, training), .standard = "10-10-2"},
    {"--optimizer", 0, "NAME", "adam, bfgs, gd (gradient descent) or lm (Levenberg-Marquardt)",
     OPTION_TEXT(Options, training.optimizer), .standard = "adam"},
    {"--iterations", 0, "N", "Full-batch steps", OPTION_INT(Options, training.iterations, 0, 1000000),
     .standard = "2000"},
    {"--seed", 0, "N", "Seed of the initial weights", OPTION_SEED(Options, training.seed), .standard = "1"},
    {"--from", 0, "NET.npz",
     "Continue from the weights of this network, such as one cut short by Ctrl-C. If NET.npz of -o has a smaller "
     "held-out "
     "error than the result, it is kept (exit status 1)",
     OPTION_PATH(Options, from)},
    {"--hidden", 0, "NAME", "Activation of the hidden layers: sigmoid (default), tanh or relu",
     OPTION_TEXT(Options, training.hidden)},
    {"--output-activation", 0, "NAME", "sigmoid or linear (default: sigmoid for two outputs, linear for six)",
     OPTION_TEXT(Options, training.output_activation)},
    {"--scale", 0, "NAME",
     "Scale of the outputs: minmax or, with linear outputs, standard (default: minmax with sigmoid, standard with "
     "linear)",
     OPTION_TEXT(Options, training.scale)},
    {"--loss", 0, "NAME",
     "Loss of the outputs: mse (default), or smooth-l1, which is linear beyond 0.3 m/s, so that rare impacts weigh "
     "less",
     OPTION_TEXT(Options, training.loss)},
    {"--laws", 0, "NAME=W,...",
     "Weights of physical laws in the loss of six outputs: momentum, energy, approach, cone. Needs a dataset recorded "
     "with --context",
     OPTION_READ(read_laws, Options, training.laws)},
    {0}};

static bool read_laws(const Option *option, const char *text, void *value, Error *error) {
    (void)option;
    return law_weights_parse(text, value, error);
}

/* "10-10-2" -> widths; a layer of weights lies between two of them. */
static bool read_layers(const Option *option, const char *text, void *value, Error *error) {
    TrainingOptions *training = value;
    int count = 0;
    for (const char *rest = text; count <= NETWORK_MAX_LAYERS; rest++) {
        size_t length = strcspn(rest, "-");
        char width[16] = "";
        int64_t parsed;
        if (length < sizeof width) memcpy(width, rest, length);
        if (!parse_int(width, 1, NETWORK_MAX_WIDTH, &parsed)) break;
        training->widths[count++] = (int)parsed;
        rest += length;
        if (*rest != '\0') continue;
        training->layers = count - 1;
        if (count >= 2) return true;
        break;
    }
    return error_input(error, option->name, "'%s' is not 2 to %d widths from 1 to %d, such as 10-10-2", text,
                       NETWORK_MAX_LAYERS + 1, NETWORK_MAX_WIDTH);
}

static void print_score(void *context, const TrainingScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%9d  %10.6f  %10.6f  %13.6f  %14.6f\n", score->iteration, score->test, score->train, score->constant_test,
           score->constant_train);
    fflush(stdout);
}

static Network *train(const Dataset *dataset, TrainingOptions *training, Error *error) {
    training->on_score = print_score;
    printf("iteration   test score  train score  constant test  constant train\n");
    Network *network = training_run(dataset, training, progress_bar_begin("training"), error);
    progress_bar_end();
    return network;
}

/* The held-out error as a share of that of always predicting the mean, so that networks of different scales compare. */
static double share(const TrainingScore *score) { return score->test / score->constant_test; }

static void print_verdict(const TrainingScore *score) {
    printf("verdict: held-out error %.6f, %.4g of the constant predictor's%s\n", score->test, share(score),
           share(score) < 1 ? "" : ": no better than the constant");
}

/* False, without an error, if a network would be replaced by a worse one. Only training that continues may: a new one is
   begun on purpose. */
static bool may_replace(const Dataset *dataset, const TrainRequest *request, const TrainingOptions *training,
                        const TrainingScore *score, Error *error) {
    TrainingScore before;
    bool there;
    if (training->start == NULL) return true;
    if (!file_find(request->output, &there, error)) return false;
    if (!there) return true;
    Network *old = network_read(request->output, error);
    if (old == NULL) return false;
    const bool scored = training_score(dataset, old, training->loss, &before, error);
    network_destroy(old);
    if (!scored || !(share(score) > share(&before))) return scored;
    printf("verdict: worse than the network in %s, which is kept: held-out error %.4g of the constant predictor's, not "
           "%.4g\n",
           request->output, share(&before), share(score));
    return false;
}

static bool store(Network *network, const Dataset *dataset, const TrainRequest *request,
                  const TrainingOptions *training, Error *error) {
    TrainingScore score;
    train_describe(request, network->command, sizeof network->command);
    if (!training_score(dataset, network, training->loss, &score, error) ||
        !may_replace(dataset, request, training, &score, error) || !network_write(network, request->output, error))
        return false;
    printf("%s%d parameters -> %s\n", interrupt_requested() ? "stopped early; " : "", network_parameter_count(network),
           request->output);
    print_verdict(&score);
    return true;
}

static bool train_and_store(const Dataset *dataset, const TrainRequest *request, TrainingOptions *training,
                            Error *error) {
    Network *network = train(dataset, training, error);
    bool ok = network != NULL && store(network, dataset, request, training, error);
    network_destroy(network);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Options given = {.from = NULL};
    if (!train_read(request, &given, error)) return false;
    Network *start = NULL;
    if (given.from != NULL && (start = network_read(given.from, error)) == NULL) return false;
    given.training.start = start;
    Dataset *dataset = dataset_read(request->input, error);
    bool ok = dataset != NULL && train_and_store(dataset, request, &given.training, error);
    dataset_destroy(dataset);
    network_destroy(start);
    return ok;
}

const TrainKind train_pair_net = {"pair-net",
                                  "DATA.npz",
                                  "a network of pairs of bodies, from a dataset. Prints its mean squared error as the "
                                  "paper's Table 1 does, beside that "
                                  "of always predicting the mean",
                                  "network",
                                  options,
                                  run};
