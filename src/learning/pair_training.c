/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of pair networks: rows in normalised blocks, option words, first weights, visits of the optimiser,
   scores. */
#include "learning/pair_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training_internal.h"
#include "methods/pair.h"
#include "nets/nets.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static float input_at(const Dataset *dataset, int64_t row, int column) {
    return dataset->inputs[row * dataset_inputs(dataset) + column];
}

typedef struct Spread {
    double minimum, maximum, mean, deviation;
} Spread;

/* Over the training rows; outputs == 0 selects an input column. Two passes: with one, the rounding of the squares would
   swamp the deviation of a column far from 0. */
static Spread column_spread(const Dataset *dataset, int outputs, int column) {
    Spread spread = {.minimum = INFINITY, .maximum = -INFINITY};
    for (int pass = 0; pass < 2; pass++) {
        double sum = 0;
        int64_t count = 0;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (dataset_is_test(dataset, row)) continue;
            double x = outputs == 0 ? input_at(dataset, row, column) : dataset_target(dataset, row, outputs, column);
            spread.minimum = fmin(spread.minimum, x);
            spread.maximum = fmax(spread.maximum, x);
            sum += pass == 0 ? x : (x - spread.mean) * (x - spread.mean);
            count++;
        }
        if (pass == 0)
            spread.mean = sum / (double)count;
        else
            spread.deviation = sqrt(sum / (double)count);
    }
    return spread;
}

/* A column keeps its scale if it varies by no more than the rounding of the largest number beside it: it is constant,
   but for the rounding of what it was computed from. Else a network would take rounding errors for its input. */
static void set_scale(Normalisation *normalisation, int column, double offset, double width, double largest) {
    const float scale = (float)(1 / width);
    normalisation->offset[column] = (float)offset;
    normalisation->scale[column] = width > 0x1p-23 * largest && isfinite(scale) && scale > 0 ? scale : 1;
}

/* Of `count` columns: spreads[count]; outputs == 0: of the inputs. Returns the largest magnitude in them. */
static double spreads_of(const Dataset *dataset, int outputs, int count, Spread *spreads) {
    double largest = 0;
    for (int i = 0; i < count; i++) {
        spreads[i] = column_spread(dataset, outputs, i);
        largest = fmax(largest, fmax(fabs(spreads[i].minimum), fabs(spreads[i].maximum)));
    }
    return largest;
}

void samples_fit_normalisation(const Dataset *dataset, OutputScale scale, Network *network) {
    Spread spreads[PAIR_INPUTS_MAX]; /* more than outputs */
    const int inputs = network->widths[0], outputs = network->widths[network->layers];
    double largest = spreads_of(dataset, 0, inputs, spreads);
    for (int i = 0; i < inputs; i++) set_scale(&network->input, i, spreads[i].mean, spreads[i].deviation, largest);
    largest = spreads_of(dataset, outputs, outputs, spreads);
    for (int k = 0; k < outputs; k++) {
        const Spread *spread = &spreads[k];
        network->output_mean[k] = (float)spread->mean;
        if (scale == SCALE_STANDARD)
            set_scale(&network->output, k, spread->mean, spread->deviation, largest);
        else
            set_scale(&network->output, k, spread->minimum, spread->maximum - spread->minimum, largest);
    }
}

/* The same float32 expression as in network_predict(), so that training and inference see the same inputs. */
static float normalise(const Normalisation *normalisation, int column, float x) {
    return (x - normalisation->offset[column]) * normalisation->scale[column];
}

Samples *samples_create(const Dataset *dataset, const Network *network, bool test, Error *error) {
    Samples *samples = calloc(1, sizeof *samples);
    if (samples == NULL) return error_memory(error, "training"), NULL;
    samples->inputs = network->widths[0];
    samples->outputs = network->widths[network->layers];
    for (int64_t row = 0; row < dataset->rows; row++) samples->rows += dataset_is_test(dataset, row) == test;
    samples->blocks = (samples->rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
    size_t padded = (size_t)samples->blocks * BLOCK_ROWS;
    samples->x = calloc(padded * (size_t)(samples->inputs + samples->outputs) + 1, sizeof *samples->x);
    if (samples->x == NULL) return error_memory(error, "training"), free(samples), NULL;
    samples->y = samples->x + padded * (size_t)samples->inputs;
    int64_t to = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (dataset_is_test(dataset, row) != test) continue;
        const int64_t b = to / BLOCK_ROWS, r = to++ % BLOCK_ROWS;
        for (int i = 0; i < samples->inputs; i++)
            samples->x[(b * samples->inputs + i) * BLOCK_ROWS + r] =
                normalise(&network->input, i, input_at(dataset, row, i));
        for (int k = 0; k < samples->outputs; k++)
            samples->y[(b * samples->outputs + k) * BLOCK_ROWS + r] =
                normalise(&network->output, k, dataset_target(dataset, row, samples->outputs, k));
    }
    return samples;
}

void samples_destroy(Samples *samples) {
    if (samples == NULL) return;
    free(samples->x);
    free(samples);
}

void samples_mean(const Samples *samples, double *mean) {
    for (int k = 0; k < samples->outputs; k++) {
        double sum = 0;
        for (int64_t b = 0; b < samples->blocks; b++)
            for (int r = 0; r < samples_in_block(samples, b); r++)
                sum += samples->y[(b * samples->outputs + k) * BLOCK_ROWS + r];
        mean[k] = sum / (double)samples->rows;
    }
}

typedef struct Word {
    const char *name; /* NULL ends a list */
    int value;
} Word;

static const Word hidden_words[] = {
    {"sigmoid", ACTIVATION_SIGMOID}, {"tanh", ACTIVATION_TANH}, {"relu", ACTIVATION_RELU}, {NULL, 0}};
static const Word output_words[] = {{"sigmoid", ACTIVATION_SIGMOID}, {"linear", ACTIVATION_LINEAR}, {NULL, 0}};
static const Word scale_words[] = {{"minmax", SCALE_MINMAX}, {"standard", SCALE_STANDARD}, {NULL, 0}};
static const Word loss_words[] = {{"mse", LOSS_MSE}, {"smooth-l1", LOSS_SMOOTH_L1}, {NULL, 0}};

/* If name is NULL, value keeps its default. */
static bool choose(const char *option, const char *name, const Word *words, int *value, Error *error) {
    if (name == NULL) return true;
    NameList known = {0};
    for (int i = 0; words[i].name != NULL; i++) {
        if (strcmp(words[i].name, name) == 0) return *value = words[i].value, true;
        name_list_add(&known, words[i].name);
    }
    return error_unknown(error, option, name, "a valid value", &known);
}

/* NULL words take the defaults of TrainingOptions. ERROR_INPUT: an unknown word, or output targets outside the range of
   the output activation. */
static bool network_config_parse(NetworkConfig *config, const TrainingOptions *options, Error *error) {
    bool two = options->widths[options->layers] == 2;
    int hidden = ACTIVATION_SIGMOID, output = two ? ACTIVATION_SIGMOID : ACTIVATION_LINEAR;
    if (!choose("hidden", options->hidden, hidden_words, &hidden, error) ||
        !choose("output activation", options->output_activation, output_words, &output, error))
        return false;
    int scale = output == ACTIVATION_LINEAR ? SCALE_STANDARD : SCALE_MINMAX;
    if (!choose("scale", options->scale, scale_words, &scale, error)) return false;
    if (output == ACTIVATION_SIGMOID && scale == SCALE_STANDARD)
        return error_input(error, "scale", "standard needs linear outputs: a sigmoid stays between 0 and 1");
    *config = (NetworkConfig){(Activation)hidden, (Activation)output, (OutputScale)scale};
    return true;
}

bool network_config_matches(const Network *start, const TrainingOptions *options, Error *error) {
    if (options->scale != NULL)
        return error_input(error, "scale", "the start network keeps its own scale; omit this option");
    int last = start->layers - 1, hidden = ACTIVATION_SIGMOID, output = (int)start->activations[last];
    if (!choose("hidden", options->hidden, hidden_words, &hidden, error) ||
        !choose("output activation", options->output_activation, output_words, &output, error))
        return false;
    for (int l = 0; options->hidden != NULL && l < last; l++)
        if (start->activations[l] != (Activation)hidden)
            return error_input(error, "hidden", "the start network has a hidden activation other than %s",
                               options->hidden);
    if (start->activations[last] == (Activation)output) return true;
    return error_input(error, "output activation", "the start network's is not %s", options->output_activation);
}

const Optimizer *const optimizers[] = {&optimizer_adam, &optimizer_bfgs, &optimizer_gd, &optimizer_lm, NULL};

static Network *new_network(const Dataset *dataset, const TrainingOptions *options, Error *error) {
    NetworkConfig config = {0};
    if (!network_config_parse(&config, options, error)) return NULL;
    Network *network = network_create(options->layers, options->widths, error);
    if (network == NULL) return NULL;
    for (int l = 0; l < network->layers; l++) network->activations[l] = config.hidden;
    network->activations[network->layers - 1] = config.output;
    snprintf(network->inputs, sizeof network->inputs, "%s", pair_views[dataset->view].inputs);
    snprintf(network->outputs, sizeof network->outputs, "%s",
             pair_output_names(dataset->view, dataset->target, options->widths[options->layers]));
    snprintf(network->target, sizeof network->target, "%s", pair_target_names[dataset->target]);
    samples_fit_normalisation(dataset, config.scale, network);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    if (rng == NULL) return network_destroy(network), error_memory(error, "training"), NULL;
    gsl_rng_set(rng, (unsigned long)((options->seed ^ options->seed >> 32) & UINT32_MAX)); /* it takes 32 bits */
    /* Glorot and Bengio, "Understanding the difficulty of training deep feedforward neural networks" (2010):
       uniform in +- sqrt(6 / (inputs + outputs)), biases 0. */
    for (int l = 0; l < network->layers; l++) {
        const int inputs = network->widths[l], outputs = network->widths[l + 1];
        const double limit = sqrt(6.0 / (inputs + outputs));
        for (int i = 0; i < inputs * outputs; i++)
            network->weights[l][i] = (float)(limit * (2 * gsl_rng_uniform(rng) - 1));
    }
    gsl_rng_free(rng);
    return network;
}

/* 0, 10, 50, 100, 1000, 2000 as the paper's Table 1, then 5000, 10000, 20000, ... */
static bool is_scored(int iteration) {
    static const int early[] = {0, 10, 50, 100};
    for (size_t i = 0; i < sizeof early / sizeof early[0]; i++)
        if (iteration == early[i]) return true;
    if (iteration < 1000) return false;
    while (iteration % 10 == 0) iteration /= 10;
    return iteration == 1 || iteration == 2 || iteration == 5;
}

static void report_score(Trainer *trainer) {
    if (trainer->scored == trainer->iteration || trainer->options->on_score == NULL) return;
    trainer->scored = trainer->iteration;
    const double *now = trainer->now;
    const double train =
        trainer->laws == NULL ? trainer->loss_now : loss_value(trainer->loss, trainer->train, NULL, now);
    TrainingScore score = {.iteration = trainer->iteration,
                           .test = loss_value(trainer->loss, trainer->test, NULL, now),
                           .train = train,
                           .constant_test = trainer->constant_test,
                           .constant_train = trainer->constant_train};
    trainer->options->on_score(trainer->options->context, &score);
}

bool trainer_visit(Trainer *trainer, const double *parameters, double train_loss, Error *error) {
    size_t size = (size_t)trainer->parameters * sizeof *parameters;
    trainer->iteration++;
    bool finite = isfinite(train_loss); /* and no parameter overflows the network's float32 */
    for (int p = 0; finite && p < trainer->parameters; p++) finite = fabs(parameters[p]) <= FLT_MAX;
    if (!finite) return error_input(error, "training", "diverged: NaN or infinite in iteration %d", trainer->iteration);
    memcpy(trainer->now, parameters, size);
    trainer->loss_now = train_loss;
    if (trainer->iteration == 0 || train_loss < trainer->best_loss) {
        memcpy(trainer->best, parameters, size);
        trainer->best_loss = train_loss;
    }
    if (is_scored(trainer->iteration)) report_score(trainer);
    /* The weights that are kept are of the lowest train loss: the held-out rows decide only when the training ends. */
    const int patience = trainer->options->patience, asked_every = patience < 10 ? patience : 10;
    if (patience > 0 && trainer->iteration % asked_every == 0) {
        const double held = loss_value(trainer->loss, trainer->test, NULL, trainer->now);
        if (trainer->iteration == 0 || held <= 0.999 * trainer->held_best)
            trainer->held_best = held, trainer->held_at = trainer->iteration;
    }
    trainer->finished = (patience > 0 && trainer->iteration - trainer->held_at >= patience) ||
                        !progress_report(trainer->progress, trainer->iteration, trainer->options->iterations) ||
                        trainer->iteration == trainer->options->iterations;
    return true;
}

/* Runs the optimiser and stores the best weights in the network. All its parameters are one block from weights[0]. */
static bool minimize(Trainer *trainer, const Optimizer *optimizer, Network *network, Error *error) {
    const size_t count = (size_t)trainer->parameters, outputs = (size_t)trainer->train->outputs;
    double *parameters = calloc(3 * count + outputs, sizeof *parameters);
    if (parameters == NULL) return error_memory(error, "training");
    double *mean = parameters + 3 * count;
    trainer->now = parameters + count;
    trainer->best = parameters + 2 * count;
    samples_mean(trainer->train, mean);
    trainer->constant_test = loss_of_constant(trainer->loss, trainer->test, mean);
    trainer->constant_train = loss_of_constant(trainer->loss, trainer->train, mean);
    for (size_t p = 0; p < count; p++) parameters[p] = (double)network->weights[0][p];
    const bool ok = optimizer->minimize(trainer, parameters, error);
    if (ok) {
        report_score(trainer);
        for (size_t p = 0; p < count; p++) network->weights[0][p] = (float)trainer->best[p];
    }
    free(parameters);
    return ok;
}

static bool train(Network *network, const Dataset *dataset, const Optimizer *optimizer, const TrainingOptions *options,
                  const Progress *progress, Error *error) {
    const bool with_laws = law_weights_any(&options->laws);
    int kind = LOSS_MSE;
    Laws *laws = with_laws ? laws_create(dataset, network, &options->laws, error) : NULL;
    Loss *loss =
        choose("loss", options->loss, loss_words, &kind, error) ? loss_create(network, (LossKind)kind, error) : NULL;
    Samples *rows = samples_create(dataset, network, false, error),
            *test = samples_create(dataset, network, true, error);
    Trainer trainer = {.options = options,
                       .progress = progress,
                       .network = network,
                       .train = rows,
                       .test = test,
                       .loss_kind = (LossKind)kind,
                       .loss = loss,
                       .laws = laws,
                       .parameters = network_parameter_count(network),
                       .iteration = -1,
                       .scored = -1};
    const bool ok = (laws != NULL || !with_laws) && loss != NULL && rows != NULL && test != NULL &&
                    minimize(&trainer, optimizer, network, error);
    samples_destroy(test);
    samples_destroy(rows);
    loss_destroy(loss);
    laws_destroy(laws);
    return ok;
}

Network *training_run(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error) {
    const Optimizer *optimizer = NULL;
    NameList known = {0};
    gsl_set_error_handler_off(); /* its default aborts */
    for (int i = 0; optimizers[i] != NULL; i++) {
        if (strcmp(optimizers[i]->name, options->optimizer) == 0) optimizer = optimizers[i];
        name_list_add(&known, optimizers[i]->name);
    }
    if (optimizer == NULL) return error_unknown(error, "optimizer", options->optimizer, "an optimizer", &known), NULL;
    if (!training_check(dataset, options, error)) return NULL;
    Network *network =
        options->start != NULL ? network_copy(options->start, error) : new_network(dataset, options, error);
    if (network != NULL && !train(network, dataset, optimizer, options, progress, error)) {
        network_destroy(network);
        network = NULL;
    }
    return network;
}

static void keep_score(void *context, const TrainingScore *score) { *(TrainingScore *)context = *score; }

bool training_score(const Dataset *dataset, const Network *network, const char *loss, TrainingScore *score,
                    Error *error) {
    TrainingOptions options = {.layers = network->layers,
                               .optimizer = optimizers[0]->name,
                               .loss = loss,
                               .on_score = keep_score,
                               .context = score,
                               .start = network};
    memcpy(options.widths, network->widths, sizeof options.widths);
    Network *same = training_run(dataset, &options, NULL, error);
    network_destroy(same);
    return same != NULL;
}
