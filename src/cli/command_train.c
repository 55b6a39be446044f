/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox train: requests, the kind pair-net, and the command, which has the options of all kinds. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/interrupt.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "nets/nets.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <assert.h>
#include <string.h>

/* The kind's option of that name ("--seed"), or -1. */
static int find_option(const TrainKind *kind, const char *name) {
    for (int i = 0; kind->options[i].name != NULL; i++)
        if (strcmp(kind->options[i].name, name) == 0) return i;
    return -1;
}

bool train_read(const TrainRequest *request, void *options, Error *error) {
    for (int i = 0; request->kind->options[i].name != NULL; i++) {
        const Option *option = &request->kind->options[i];
        if (request->values[i] == NULL) continue;
        if (!option->read(option, request->values[i], (char *)options + option->at, error)) return false;
    }
    return true;
}

void train_describe(const TrainRequest *request, char *command, size_t size) {
    snprintf(command, size, "twinbox train");
    if (request->kind != train_kinds[0]) text_add(command, size, " --kind %s", request->kind->name);
    if (request->input != NULL) text_add(command, size, " %s", request->input);
    text_add(command, size, " -o %s", request->output);
    for (int i = 0; request->kind->options[i].name != NULL; i++) {
        const Option *option = &request->kind->options[i];
        if (request->values[i] == NULL) continue;
        text_add(command, size, " %s", option->name);
        /* A value that begins with '-' would be taken for an option. */
        const bool negative = option->standard != NULL && option->standard[0] == '-';
        if (option->value != NULL) text_add(command, size, "%s%s", negative ? "=" : " ", request->values[i]);
    }
}

typedef struct PairNetOptions {
    TrainingOptions training;
    const char *from; /* NET.npz, or NULL */
} PairNetOptions;

static OptionRead read_layers, read_laws;

static const Option pair_net_options[] = {
    {"--layers", 0, "WIDTHS",
     "Widths of the layers. 10-10-2: change of relative velocity, min-max outputs, as in the paper's 3.2. With two "
     "hidden layers and all six changes: 10-8-8-6, standardised outputs, as in its 3.1",
     OPTION_READ(read_layers, PairNetOptions, training), .standard = "10-10-2"},
    {"--optimizer", 0, "NAME", "adam, bfgs, gd (gradient descent) or lm (Levenberg-Marquardt)",
     OPTION_TEXT(PairNetOptions, training.optimizer), .standard = "adam"},
    {"--iterations", 0, "N", "Full-batch steps", OPTION_INT(PairNetOptions, training.iterations, 0, 1000000),
     .standard = "2000"},
    {"--seed", 0, "N", "Seed of the initial weights", OPTION_SEED(PairNetOptions, training.seed), .standard = "1"},
    {"--from", 0, "NET.npz",
     "Continue from the weights of this network, such as one cut short by Ctrl-C. If NET.npz of -o has a smaller "
     "held-out error than the result, it is kept (exit status 1)",
     OPTION_PATH(PairNetOptions, from)},
    {"--hidden", 0, "NAME", "Activation of the hidden layers: sigmoid (default), tanh or relu",
     OPTION_TEXT(PairNetOptions, training.hidden)},
    {"--output-activation", 0, "NAME", "sigmoid or linear (default: sigmoid for two outputs, linear for six)",
     OPTION_TEXT(PairNetOptions, training.output_activation)},
    {"--scale", 0, "NAME",
     "Scale of the outputs: minmax or, with linear outputs, standard (default: minmax with sigmoid, standard with "
     "linear)",
     OPTION_TEXT(PairNetOptions, training.scale)},
    {"--loss", 0, "NAME",
     "Loss of the outputs: mse (default), or smooth-l1, which is linear beyond 0.3 m/s, so that rare impacts weigh "
     "less",
     OPTION_TEXT(PairNetOptions, training.loss)},
    {"--laws", 0, "NAME=W,...",
     "Weights of physical laws in the loss of six outputs: momentum, energy, approach, cone. Needs a dataset recorded "
     "with --context",
     OPTION_READ(read_laws, PairNetOptions, training.laws)},
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
        int64_t width;
        if (!parse_leading_int(rest, 1, NETWORK_MAX_WIDTH, &width, &rest) || (*rest != '-' && *rest != '\0')) break;
        training->widths[count++] = (int)width;
        if (*rest == '-') continue;
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

/* The held-out error as a share of that of always predicting the mean, so that networks of different scales compare. */
static double share(const TrainingScore *score) { return score->test / score->constant_test; }

/* False, without an error, if a network would be replaced by a worse one. Only training that continues may: a new one
   is begun on purpose. */
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

static bool pair_net_run(const TrainRequest *request, Error *error) {
    PairNetOptions given = {.from = NULL};
    TrainingOptions *training = &given.training;
    TrainingScore score;
    if (!train_read(request, &given, error)) return false;
    Network *start = given.from != NULL ? network_read(given.from, error) : NULL, *network = NULL;
    Dataset *dataset = given.from == NULL || start != NULL ? dataset_read(request->input, error) : NULL;
    if (dataset != NULL) {
        training->start = start;
        training->on_score = print_score;
        printf("iteration   test score  train score  constant test  constant train\n");
        network = training_run(dataset, training, progress_bar_begin("training"), error);
        progress_bar_end();
    }
    bool ok = network != NULL;
    if (ok) {
        train_describe(request, network->command, sizeof network->command);
        ok = training_score(dataset, network, training->loss, &score, error) &&
             may_replace(dataset, request, training, &score, error) && network_write(network, request->output, error);
    }
    if (ok) {
        printf("%s%d parameters -> %s\n", interrupt_requested() ? "stopped early; " : "",
               network_parameter_count(network), request->output);
        printf("verdict: held-out error %.6f, %.4g of the constant predictor's%s\n", score.test, share(&score),
               share(&score) < 1   ? ""
               : share(&score) > 1 ? ": worse than the constant"
                                   : ": no better than the constant");
    }
    network_destroy(network);
    dataset_destroy(dataset);
    network_destroy(start);
    return ok;
}

const TrainKind train_pair_net = {
    .name = "pair-net",
    .input = "DATA.npz",
    .summary =
        "a network of pairs of bodies, from a dataset. Prints its mean squared error as the paper's Table 1 does, "
        "beside that of always predicting the mean",
    .file_kind = "network",
    .options = pair_net_options,
    .train = pair_net_run};

#define TRAIN_KIND_ENTRY(name) &train_##name,
const TrainKind *const train_kinds[] = {TRAIN_KINDS(TRAIN_KIND_ENTRY) NULL};

enum { KINDS = sizeof train_kinds / sizeof *train_kinds - 1, TEXT_SIZE = 2048 };

/* The options of all kinds, as given, before it is known what the kind takes. */
typedef struct Options {
    const char *kind, *input, *output;
    int row_count;
    Option rows[OPTIONS_MAX + 1];
    const char *values[OPTIONS_MAX + 1]; /* of the rows */
} Options;

/* The texts of the help that are made from the kinds. */
typedef struct HelpTexts {
    char kind[TEXT_SIZE], headings[KINDS][TEXT_SIZE], usage[TEXT_SIZE];
    const char *names[KINDS + 1]; /* ended by NULL */
} HelpTexts;

static bool remember(const Option *option, const char *text, void *value, Error *error) {
    (void)error;
    Options *options = value;
    options->values[option - options->rows] = text != NULL ? text : "";
    return true;
}

static void add_row(Options *options, Option row) {
    assert(options->row_count < OPTIONS_MAX);
    options->rows[options->row_count++] = row;
}

/* The kinds that have the option; NULL: all. */
static NameList name_kinds(const char *option) {
    NameList names = {0};
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        if (option == NULL || find_option(*kind, option) >= 0) name_list_add(&names, (*kind)->name);
    return names;
}

/* The rows of the command: its own, then a heading and the options of each kind. */
static void make_table(Options *options, HelpTexts *texts) {
    snprintf(texts->kind, TEXT_SIZE, "What to train: %s", name_kinds(NULL).text);
    add_row(options, (Option){"--output", 'o', "NET.npz", "File that the network is written to",
                              OPTION_BINARY(Options, output), .needed = "-o NET.npz is needed"});
    for (int k = 0; k < KINDS; k++) texts->names[k] = train_kinds[k]->name;
    add_row(options, (Option){"--kind", 0, "NAME", texts->kind, OPTION_TEXT(Options, kind), .names = texts->names,
                              .standard = train_kinds[0]->name});
    for (int k = 0; k < KINDS; k++) {
        const TrainKind *kind = train_kinds[k];
        text_add(texts->usage, sizeof texts->usage, "%s%s%s%s", k == 0 ? "" : "\n--kind ", k == 0 ? "" : kind->name,
                 k == 0 || kind->input == NULL ? "" : " ", kind->input != NULL ? kind->input : "");
        snprintf(texts->headings[k], TEXT_SIZE, "%s%s: %s.", kind->name, k == 0 ? " (default)" : "", kind->summary);
        add_row(options, (Option){.help = texts->headings[k]});
        for (const Option *option = kind->options; option->name != NULL; option++) {
            Option row = *option;
            row.read = remember;
            row.at = 0;
            add_row(options, row);
        }
    }
}

static bool make_request(const Options *options, TrainRequest *request, Error *error) {
    *request = (TrainRequest){.input = options->input, .output = options->output};
    for (int k = 0; k < KINDS; k++)
        if (strcmp(train_kinds[k]->name, options->kind) == 0) request->kind = train_kinds[k];
    const NameList known = name_kinds(NULL);
    if (request->kind == NULL) return error_unknown(error, "--kind", options->kind, "a kind", &known);
    if ((request->input == NULL) != (request->kind->input == NULL))
        return request->input == NULL
                   ? error_input(error, request->kind->name, "a file to train on is needed: %s", request->kind->input)
                   : error_input(error, request->input, "%s takes no file to train on", request->kind->name);
    for (int i = 0; request->kind->options[i].name != NULL; i++)
        request->values[i] = request->kind->options[i].standard;
    for (int i = 0; i < options->row_count; i++) {
        if (options->values[i] == NULL) continue;
        const char *name = options->rows[i].name;
        const int option = find_option(request->kind, name);
        if (option < 0)
            return error_input(error, name, "is an option of %s, not of %s", name_kinds(name).text,
                               request->kind->name);
        request->values[option] = options->values[i];
    }
    return true;
}

bool command_train(int argc, char **argv, Error *error) {
    Options options = {.kind = train_kinds[0]->name};
    HelpTexts texts = {.usage = ""};
    make_table(&options, &texts);
    const CommandSpec spec = {
        .options = options.rows,
        .input = {.value = texts.usage, .needed = "a dataset (or scene) is needed", OPTION_PATH(Options, input)},
        .inputs = {0, 1, "file"},
        .help = "Train the network of a method. Ctrl-C and SIGTERM stop it, and keep what it has learned so far: of "
                "pair-net the best network, of the others the latest.\v"
                "Example: twinbox dataset single --bomb-x=-4:4:1 -o pairs.npz\n"
                "         twinbox train pairs.npz -o net.npz --layers 10-10-2 --iterations 100\n"
                "         twinbox train --kind scene-net stack -o scene-net.npz"};
    TrainRequest request;
    if (!options_parse(&spec, argc, argv, &options, error) || !make_request(&options, &request, error) ||
        !output_check_npz(request.output, request.kind->file_kind, error))
        return false;
    char command[TRAIN_COMMAND_SIZE];
    train_describe(&request, command, sizeof command);
    note_verbose("with all options: %s", command);
    Scene *scene = request.kind->reads_scene ? scene_read(request.input, error) : NULL;
    request.scene = scene;
    const bool ok = (!request.kind->reads_scene || (scene != NULL && scene_check_strike(scene, error))) &&
                    request.kind->train(&request, error);
    scene_destroy(scene);
    return ok;
}
