/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/train_momentum.h"
#include "cli/train_scene_net.h"
#include "training/training.h"

#include <stdio.h>
#include <string.h>

enum {
    LAYERS = 256,
    OPTIMIZER,
    ITERATIONS,
    SEED,
    FROM,
    KIND,
    BOMB_X,
    HIDDEN,
    OUTPUT_ACTIVATION,
    SCALE,
    LOSS,
    LAWS_IN_LOSS,
    LAUNCHES,
    ROUNDS,
    WIDTH,
    SWEEPS,
    MOMENTUM,
    WITHIN,
    SMALLEST
};

static const struct argp_option option_table[] = {
    {"output", 'o', "NET.npz", 0, "Where the network goes", 0},
    {"kind", KIND, "NAME", 0,
     "pair-net (default): from a dataset; momentum-schedule: a SCENE's factors for learned-momentum, by CMA-ES; "
     "scene-net: a network for a SCENE's impacts",
     0},
    {"layers", LAYERS, "WIDTHS", 0,
     "10-10-2 (default; change of relative velocity, min-max outputs, as in the paper's 3.2) or, with two hidden "
     "layers and all six changes, 10-8-8-6 (standardised, as in its 3.1)",
     0},
    {"optimizer", OPTIMIZER, "NAME", 0, "adam (default), bfgs, gd (plain gradient descent) or lm (Levenberg-Marquardt)",
     0},
    {"hidden", HIDDEN, "NAME", 0, "Activation of hidden layers: sigmoid (default), tanh or relu", 0},
    {"output-activation", OUTPUT_ACTIVATION, "NAME", 0,
     "sigmoid or linear (default: sigmoid for two outputs, linear for six)", 0},
    {"scale", SCALE, "NAME", 0,
     "Of outputs: minmax or, with linear outputs, standard (default: minmax with sigmoid, standard with linear)", 0},
    {"loss", LOSS, "NAME", 0,
     "Of outputs: mse (default), or smooth-l1, straight beyond 0.3 m/s, which rare impacts do not rule", 0},
    {"laws", LAWS_IN_LOSS, "NAME=W,...", 0,
     "Weights of laws in the loss of six outputs: momentum, energy, approach, cone; from a dataset made with --context",
     0},
    {"iterations", ITERATIONS, "N", 0, "Full-batch steps (default: 2000), generations (100), or epochs (40)", 0},
    {"seed", SEED, "N", 0, "Of the initial weights, or of the search (default: 1)", 0},
    {"bomb-x", BOMB_X, "A:B:STEP", 0, "Launches that a momentum schedule is fitted to, m (default: -5:5:0.5)", 0},
    {"launches", LAUNCHES, "N", 0, "scene-net: launches of each round, half of them turned and spinning (3000)", 0},
    {"rounds", ROUNDS, "N", 0, "scene-net: the first without the network, the others with it (3)", 0},
    {"width", WIDTH, "N", 0, "scene-net: of both hidden layers, a multiple of 16 (64)", 0},
    {"sweeps", SWEEPS, "K", 0, "scene-net: that follow the network (14)", 0},
    {"momentum", MOMENTUM, "on|off", 0, "scene-net: those sweeps have learned factors of momentum (on)", 0},
    {"smallest", SMALLEST, NULL, 0, "scene-net: the smallest width that does", 0},
    {"within", WITHIN, "E", 0, "With --smallest: the held-out error that it has to reach, m/s", 0},
    {"from", FROM, "NET.npz", 0, "Go on from the weights of this network, such as one cut short by Ctrl-C", 0},
    {0}};

typedef struct Options {
    const char *data, *output, *layers, *optimizer, *iterations, *seed, *from, *kind, *bomb_x, *hidden,
        *output_activation, *scale, *loss, *laws, *launches, *rounds, *width, *sweeps, *momentum, *within;
    bool smallest;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case LAYERS: options->layers = value; break;
    case OPTIMIZER: options->optimizer = value; break;
    case ITERATIONS: options->iterations = value; break;
    case SEED: options->seed = value; break;
    case FROM: options->from = value; break;
    case KIND: options->kind = value; break;
    case BOMB_X: options->bomb_x = value; break;
    case HIDDEN: options->hidden = value; break;
    case OUTPUT_ACTIVATION: options->output_activation = value; break;
    case SCALE: options->scale = value; break;
    case LOSS: options->loss = value; break;
    case LAWS_IN_LOSS: options->laws = value; break;
    case LAUNCHES: options->launches = installed_path(value); break;
    case ROUNDS: options->rounds = value; break;
    case WIDTH: options->width = value; break;
    case SWEEPS: options->sweeps = value; break;
    case MOMENTUM: options->momentum = value; break;
    case SMALLEST: options->smallest = true; break;
    case WITHIN: options->within = value; break;
    case ARGP_KEY_ARG:
        if (options->data != NULL) argp_error(state, "one file at a time ('%s' is a second)", value);
        options->data = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->data == NULL) argp_error(state, "a dataset (or scene) is needed");
        if (options->output == NULL) argp_error(state, "-o NET.npz is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "DATA.npz\n--kind momentum-schedule SCENE\n--kind scene-net SCENE",
    "Train a network on a dataset; print its mean squared error as the paper's Table 1 does, beside that of always "
    "predicting the mean. Ctrl-C stops and keeps the best network so far.\v"
    "Example: twinbox train pairs.npz -o pair-net.npz --layers 10-10-2 --optimizer lm --iterations 100",
    NULL,
    NULL,
    NULL};

/* "10-10-2" -> widths; their number less one is the number of weight layers. */
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

static void append(Network *network, const char *option, const char *value) {
    size_t length = strlen(network->command);
    if (value != NULL) snprintf(network->command + length, sizeof network->command - length, "%s%s", option, value);
}

/* The command as one would type it again. */
static void describe(Network *network, const Options *options) {
    snprintf(network->command, sizeof network->command,
             "twinbox train %s -o %s --layers %s --optimizer %s --iterations %s --seed %s", options->data,
             options->output, options->layers, options->optimizer,
             options->iterations != NULL ? options->iterations : "2000", options->seed);
    append(network, " --from ", options->from);
    append(network, " --hidden ", options->hidden);
    append(network, " --output-activation ", options->output_activation);
    append(network, " --scale ", options->scale);
    append(network, " --loss ", options->loss);
    append(network, " --laws ", options->laws);
}

static bool train_and_store(const Dataset *dataset, const Options *options, TrainingOptions *training, Error *error) {
    Network *network = train(dataset, training, error);
    bool ok = network != NULL;
    if (ok) {
        describe(network, options);
        ok = network_write(network, options->output, error);
    }
    if (ok)
        printf("%s%d parameters -> %s\n", progress_interrupted() ? "stopped early; " : "",
               network_parameter_count(network), options->output);
    network_destroy(network);
    return ok;
}

static int train_pair_net(const Options *options, Error *error) {
    TrainingOptions training = {.optimizer = options->optimizer,
                                .hidden = options->hidden,
                                .output_activation = options->output_activation,
                                .scale = options->scale,
                                .loss = options->loss};
    const char *iterations = options->iterations != NULL ? options->iterations : "2000";
    if (!parse_layers(options->layers, &training, error) ||
        !option_int("--iterations", iterations, 0, 1000000, &training.iterations, error) ||
        !option_seed("--seed", options->seed, &training.seed, error) ||
        (options->laws != NULL && !law_weights_parse(options->laws, &training.laws, error)))
        return STATUS_DIFFERENT;
    Network *start = NULL;
    if (options->from != NULL && (start = network_read(options->from, error)) == NULL) return STATUS_DIFFERENT;
    training.start = start;
    Dataset *dataset = dataset_read(options->data, error);
    bool ok = dataset != NULL && train_and_store(dataset, options, &training, error);
    dataset_destroy(dataset);
    network_destroy(start);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}

int command_train(int argc, char **argv, Error *error) {
    Options options = {.layers = "10-10-2",
                       .optimizer = "adam",
                       .seed = "1",
                       .kind = "pair-net",
                       .bomb_x = "-5:5:0.5",
                       .launches = "3000",
                       .rounds = "3",
                       .width = "64",
                       .sweeps = "14",
                       .momentum = "on"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    if (strcmp(options.kind, "momentum-schedule") == 0) {
        const TrainMomentum momentum = {options.data, options.output,
                                        options.iterations != NULL ? options.iterations : "100", options.seed,
                                        options.bomb_x};
        return train_momentum(&momentum, error) ? STATUS_SAME : STATUS_DIFFERENT;
    }
    if (strcmp(options.kind, "scene-net") == 0) {
        const TrainSceneNet scene_net = {
            options.data,     options.output,   options.iterations != NULL ? options.iterations : "40",
            options.seed,     options.launches, options.rounds,
            options.width,    options.sweeps,   options.momentum,
            options.smallest, options.within};
        return train_scene_net(&scene_net, error) ? STATUS_SAME : STATUS_DIFFERENT;
    }
    if (strcmp(options.kind, "pair-net") == 0) return train_pair_net(&options, error);
    error_input(error, "--kind", "'%s' is no kind; there are pair-net, momentum-schedule and scene-net", options.kind);
    return STATUS_DIFFERENT;
}
