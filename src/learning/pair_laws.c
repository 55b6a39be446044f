/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of pair networks: laws of physics and their terms, the loss, and checks of the options. */
#include "base/base.h"
#include "base/settings.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "learning/pair_training_internal.h"
#include "methods/pair.h"
#include "nets/nets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double inertia(float inverse) { return inverse > 0 ? 1 / (double)inverse : 0; }

/* The normal velocity of a body's point at `arm`, as weights of the body's velocity and spin. */
static void set_approach(double approach[3], double sign, const double normal[2], const float arm[2]) {
    approach[0] = sign * normal[0];
    approach[1] = sign * normal[1];
    approach[2] = sign * ((double)arm[0] * normal[1] - (double)arm[1] * normal[0]);
}

LawPair law_pair(const float context[PAIR_CONTEXT]) {
    LawPair pair = {.normal = {(double)context[CONTEXT_NORMAL], (double)context[CONTEXT_NORMAL + 1]},
                    .friction = (double)context[CONTEXT_FRICTION]};
    pair.mass[0] = pair.mass[1] = inertia(context[CONTEXT_INV_MASS_A]);
    pair.mass[2] = inertia(context[CONTEXT_INV_INERTIA_A]);
    pair.mass[3] = pair.mass[4] = inertia(context[CONTEXT_INV_MASS_B]);
    pair.mass[5] = inertia(context[CONTEXT_INV_INERTIA_B]);
    for (int k = 0; k < PAIR_CHANGES; k++) pair.velocity[k] = (double)context[CONTEXT_VELOCITIES + k];
    if (pair.mass[0] > 0) set_approach(pair.approach, -1, pair.normal, context + CONTEXT_ARM_A);
    if (pair.mass[3] > 0) set_approach(pair.approach + 3, 1, pair.normal, context + CONTEXT_ARM_B);
    return pair;
}

/* The pair's impulse J is computed from one dynamic body's velocity change: its first index, and the factor of J. */
static int impulse_body(const LawPair *pair) { return pair->mass[3] > 0 ? 3 : 0; }
static double impulse_mass(const LawPair *pair) { return pair->mass[3] > 0 ? pair->mass[3] : -pair->mass[0]; }

static double impulse_size(const LawPair *pair, const double change[PAIR_CHANGES]) {
    const double *given = change + impulse_body(pair);
    return fabs(impulse_mass(pair)) * sqrt(given[0] * given[0] + given[1] * given[1]);
}

static double momentum_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    const double a = pair->mass[0], b = pair->mass[3];
    memset(slope, 0, PAIR_CHANGES * sizeof *slope);
    if (a == 0 || b == 0) return 0;
    const double x = a * change[0] + b * change[3], y = a * change[1] + b * change[4], size = sqrt(x * x + y * y);
    if (size == 0) return 0;
    slope[0] = a * x / size, slope[1] = a * y / size;
    slope[3] = b * x / size, slope[4] = b * y / size;
    return size;
}

static double energy_change(const LawPair *pair, const double change[PAIR_CHANGES]) {
    double rise = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) rise += pair->mass[k] * change[k] * (pair->velocity[k] + change[k] / 2);
    return rise;
}

static double energy_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    for (int k = 0; k < PAIR_CHANGES; k++) slope[k] = pair->mass[k] * (pair->velocity[k] + change[k]);
    return fmax(0, energy_change(pair, change));
}

static double approach_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    double parting = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) {
        parting += pair->approach[k] * (pair->velocity[k] + change[k]);
        slope[k] = -pair->approach[k];
    }
    return fmax(0, -parting);
}

static double approach_size(const LawPair *pair, const double change[PAIR_CHANGES]) {
    double sum = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) sum += pair->approach[k] * change[k];
    return sum;
}

static double cone_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    const double n[2] = {pair->normal[0], pair->normal[1]}, t[2] = {n[1], -n[0]}, mass = impulse_mass(pair);
    const double *given = change + impulse_body(pair);
    double *by_given = slope + impulse_body(pair);
    const double along = mass * (given[0] * n[0] + given[1] * n[1]),
                 across = mass * (given[0] * t[0] + given[1] * t[1]);
    const double side = across < 0 ? -1 : 1, outside = fabs(across) - pair->friction * fmax(along, 0);
    memset(slope, 0, PAIR_CHANGES * sizeof *slope);
    for (int i = 0; i < 2; i++) {
        if (outside > 0) by_given[i] += mass * side * t[i];
        if (outside > 0 && along > 0) by_given[i] -= mass * pair->friction * n[i];
        if (along < 0) by_given[i] -= mass * n[i];
    }
    return fmax(0, outside) + fmax(0, -along);
}

const Law laws_known[LAWS] = {
    [LAW_MOMENTUM] = {"momentum", "N s", "the pair's momentum is conserved", momentum_violation, impulse_size},
    [LAW_ENERGY] = {"energy", "J", "the pair's kinetic energy does not increase", energy_violation, energy_change},
    [LAW_APPROACH] = {"approach", "m/s", "the bodies no longer approach", approach_violation, approach_size},
    [LAW_CONE] = {"cone", "N s", "the impulse pushes and is within Coulomb's friction cone", cone_violation,
                  impulse_size}};

/* A training row. */
typedef struct LawRow {
    LawPair pair;
    double label[LAWS]; /* violation of each law by the label */
} LawRow;

struct Laws {
    const Network *network;
    double factor[LAWS]; /* weight / scale * outputs; 0: law not used */
    LawRow *rows;
};

bool laws_check(const Dataset *dataset, int outputs, const LawNumbers *weights, Error *error) {
    for (int law = 0; law < LAWS; law++)
        if (!(weights->of[law] >= 0 && isfinite(weights->of[law])))
            return error_input(error, "laws", "the weight of %s must be 0 or more (got %g)", laws_known[law].name,
                               weights->of[law]);
    if (dataset->target != TARGET_PAIR || pair_views[dataset->view].by_contact)
        return error_input(error, "laws", "need a dataset with target pair in world axes (got target %s, view %s)",
                           pair_target_names[dataset->target], pair_views[dataset->view].name);
    if (outputs != PAIR_CHANGES)
        return error_input(error, "laws", "need a network with %d outputs, such as 10-8-8-6 (got %d)", PAIR_CHANGES,
                           outputs);
    if (dataset->context != NULL) return true;
    return error_input(error, "laws", "the dataset has no context; record it again with --context");
}

static void label_change(const Dataset *dataset, int64_t row, double change[PAIR_CHANGES]) {
    for (int k = 0; k < PAIR_CHANGES; k++) change[k] = (double)dataset->changes[row * PAIR_CHANGES + k];
}

static void pair_laws_fill(Laws *laws, const Dataset *dataset, const LawNumbers *weights) {
    double change[PAIR_CHANGES], slope[PAIR_CHANGES], squares[LAWS] = {0};
    int64_t count = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (dataset_is_test(dataset, row)) continue;
        LawRow *to = &laws->rows[count++];
        to->pair = law_pair(dataset->context + row * PAIR_CONTEXT);
        label_change(dataset, row, change);
        for (int law = 0; law < LAWS; law++) {
            const double size = laws_known[law].size(&to->pair, change);
            squares[law] += size * size;
            to->label[law] = laws_known[law].violation(&to->pair, change, slope);
        }
    }
    for (int law = 0; law < LAWS; law++) {
        const double scale = squares[law] / (double)count;
        laws->factor[law] = PAIR_CHANGES * weights->of[law] / (scale > 0 ? scale : 1);
    }
}

Laws *laws_create(const Dataset *dataset, const Network *network, const LawNumbers *weights, Error *error) {
    int64_t count = 0;
    for (int64_t row = 0; row < dataset->rows; row++) count += !dataset_is_test(dataset, row);
    Laws *laws = calloc(1, sizeof *laws);
    LawRow *rows = malloc((size_t)(count + 1) * sizeof *rows);
    if (laws == NULL || rows == NULL) return error_memory(error, "training"), free(laws), free(rows), NULL;
    laws->network = network;
    laws->rows = rows;
    pair_laws_fill(laws, dataset, weights);
    return laws;
}

void laws_destroy(Laws *laws) {
    if (laws == NULL) return;
    free(laws->rows);
    free(laws);
}

/* Half the derivative of factor * excess^2 with respect to one row's outputs; `excess` includes the factor. */
double laws_add(const Laws *laws, const NetworkBlock *block, int64_t b, int rows, double *half_slopes) {
    const Normalisation *output = &laws->network->output;
    const double *prediction = block->values[block->shape->layers];
    double sum = 0, change[PAIR_CHANGES], slope[PAIR_CHANGES];
    for (int r = 0; r < rows; r++) {
        const LawRow *row = &laws->rows[b * BLOCK_ROWS + r];
        for (int k = 0; k < PAIR_CHANGES; k++)
            change[k] = prediction[k * BLOCK_ROWS + r] / (double)output->scale[k] + (double)output->offset[k];
        for (int law = 0; law < LAWS; law++) {
            if (laws->factor[law] == 0) continue;
            const double excess = laws_known[law].violation(&row->pair, change, slope) - row->label[law];
            if (excess <= 0) continue;
            sum += laws->factor[law] * excess * excess;
            for (int k = 0; k < PAIR_CHANGES; k++)
                half_slopes[k * BLOCK_ROWS + r] += laws->factor[law] * excess * slope[k] / (double)output->scale[k];
        }
    }
    return sum;
}

bool laws_measure(const Dataset *dataset, const Network *network, LawNumbers *violations, Error *error) {
    const LawNumbers none = {{0}};
    float *scratch = NULL, output[PAIR_CHANGES];
    double change[PAIR_CHANGES], slope[PAIR_CHANGES];
    int64_t count = 0;
    if (!laws_check(dataset, network != NULL ? network->widths[network->layers] : PAIR_CHANGES, &none, error))
        return false;
    if (network != NULL && strcmp(network->inputs, pair_views[dataset->view].inputs) != 0)
        return error_input(error, "laws", "the network has other inputs (%.80s)", network->inputs);
    if (network != NULL) {
        scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch);
        if (scratch == NULL) return error_memory(error, "laws");
    }
    *violations = none;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!dataset_is_test(dataset, row)) continue;
        const LawPair pair = law_pair(dataset->context + row * PAIR_CONTEXT);
        label_change(dataset, row, change);
        if (network != NULL) network_predict(network, dataset->inputs + row * dataset_inputs(dataset), scratch, output);
        for (int k = 0; network != NULL && k < PAIR_CHANGES; k++) change[k] = (double)output[k];
        for (int law = 0; law < LAWS; law++) violations->of[law] += laws_known[law].violation(&pair, change, slope);
        count++;
    }
    free(scratch);
    for (int law = 0; law < LAWS; law++) violations->of[law] /= (double)count;
    return count > 0 || error_input(error, "laws", "the dataset has no test rows");
}

bool law_weights_any(const LawNumbers *weights) {
    for (int law = 0; law < LAWS; law++)
        if (weights->of[law] != 0) return true;
    return false;
}

bool law_weights_parse(const char *text, LawNumbers *weights, Error *error) {
    SettingSpec known[LAWS + 1] = {{0}};
    Settings settings;
    for (int law = 0; law < LAWS; law++)
        known[law] = (SettingSpec){laws_known[law].name, laws_known[law].summary, SETTING_OWN};
    if (!settings_parse(&settings, text, known, "laws", error)) return false;
    *weights = (LawNumbers){{0}};
    for (int law = 0; law < LAWS; law++) {
        const char *value = settings_get(&settings, laws_known[law].name);
        if (value != NULL && !(parse_double(value, &weights->of[law]) && weights->of[law] >= 0))
            return error_input(error, "laws", "%s: '%s' is not a number of 0 or more", laws_known[law].name, value);
    }
    return true;
}

bool law_weights_named(const char *laws, double weight, LawNumbers *weights, Error *error) {
    bool found = strcmp(laws, "none") == 0;
    *weights = (LawNumbers){{0}};
    NameList known = {0};
    name_list_add(&known, "none");
    for (int law = 0; law < LAWS; law++) {
        name_list_add(&known, laws_known[law].name);
        if (strcmp(laws, "all") != 0 && strcmp(laws, laws_known[law].name) != 0) continue;
        weights->of[law] = weight;
        found = true;
    }
    name_list_add(&known, "all");
    return found || error_unknown(error, "laws", laws, "a law", &known);
}

/* Sums over all rows in parallel. Own loops instead of BLAS: the same bits on any machine, and as fast for layers of
   ten units (products of 10^6 rows of 10-10-2: 0.033 s; OpenBLAS: 0.043 s). */

/* Enough chunks to keep many cores busy. Large networks have fewer, because each chunk stores a gradient. */
enum { MAX_CHUNKS = 32, MAX_GRADIENT_NUMBERS = 1 << 23 };

/* A range of rows, summed by one thread. */
typedef struct Chunk {
    NetworkBlock *block;
    double *gradient; /* [parameters] */
    double sum;       /* of the losses */
} Chunk;

struct Loss {
    int parameters, outputs, last; /* last: index of the last layer */
    double *thresholds;            /* [outputs] |d| beyond which the loss is linear; infinity for mse */
    int chunk_count;
    Chunk chunks[MAX_CHUNKS];
};

/* Returns the loss of one error and replaces the error by half the loss's slope: the error, clamped to the threshold.
   An infinite threshold gives exactly the square and the error. */
static double error_loss(double *error, double threshold) {
    double size = fabs(*error), inner = size < threshold ? size : threshold;
    *error = copysign(inner, *error);
    return inner * (2 * size - inner);
}

Loss *loss_create(const Network *shape, LossKind kind, Error *error) {
    Loss *loss = calloc(1, sizeof *loss);
    if (loss == NULL) return error_memory(error, "training"), NULL;
    loss->parameters = network_parameter_count(shape);
    loss->last = shape->layers - 1;
    loss->outputs = shape->widths[shape->layers];
    loss->thresholds = malloc((size_t)loss->outputs * sizeof *loss->thresholds);
    if (loss->thresholds == NULL) return error_memory(error, "training"), loss_destroy(loss), NULL;
    for (int k = 0; k < loss->outputs; k++)
        loss->thresholds[k] = kind == LOSS_MSE ? INFINITY : SMOOTH_L1_THRESHOLD * (double)shape->output.scale[k];
    int affordable = MAX_GRADIENT_NUMBERS / loss->parameters;
    loss->chunk_count = affordable < 1 ? 1 : affordable < MAX_CHUNKS ? affordable : MAX_CHUNKS;
    for (int c = 0; c < loss->chunk_count; c++) {
        loss->chunks[c].block = network_block_create(shape, error);
        loss->chunks[c].gradient = calloc((size_t)loss->parameters, sizeof(double));
        if (loss->chunks[c].block == NULL || loss->chunks[c].gradient == NULL)
            return error_memory(error, "training"), loss_destroy(loss), NULL;
    }
    return loss;
}

void loss_destroy(Loss *loss) {
    if (loss == NULL) return;
    for (int c = 0; c < loss->chunk_count; c++) {
        network_block_destroy(loss->chunks[c].block);
        free(loss->chunks[c].gradient);
    }
    free(loss->thresholds);
    free(loss);
}

void loss_forward(NetworkBlock *block, const Samples *samples, int64_t b, const double *parameters) {
    int count = samples->inputs * BLOCK_ROWS;
    const float *x = samples->x + b * count;
    for (int i = 0; i < count; i++) block->values[0][i] = (double)x[i];
    network_forward(block, parameters);
}

/* Returns the sum of the losses. errors[outputs, BLOCK_ROWS] = half the loss's slope with respect to each prediction
   (for mse: prediction - target), 0 in padding rows. */
static double block_errors(const Loss *loss, const NetworkBlock *block, const Samples *samples, int64_t b,
                           double *errors) {
    const double *prediction = block->values[block->shape->layers];
    const float *target = samples->y + b * samples->outputs * BLOCK_ROWS;
    int rows = samples_in_block(samples, b);
    double sum = 0;
    for (int k = 0; k < samples->outputs; k++)
        for (int r = 0; r < BLOCK_ROWS; r++) {
            int i = k * BLOCK_ROWS + r;
            errors[i] = r < rows ? prediction[i] - (double)target[i] : 0;
            sum += error_loss(&errors[i], loss->thresholds[k]);
        }
    return sum;
}

/* The first block of chunk c; chunk c ends where chunk c + 1 starts. */
static int64_t chunk_start(const Loss *loss, const Samples *samples, int c) {
    return samples->blocks * c / loss->chunk_count;
}

static void sum_chunk(const Loss *loss, Chunk *chunk, const Samples *samples, const Laws *laws, int c,
                      const double *parameters, bool with_gradient) {
    double *errors = chunk->block->deltas[loss->last];
    chunk->sum = 0;
    memset(chunk->gradient, 0, (size_t)loss->parameters * sizeof(double));
    for (int64_t b = chunk_start(loss, samples, c); b < chunk_start(loss, samples, c + 1); b++) {
        loss_forward(chunk->block, samples, b, parameters);
        chunk->sum += block_errors(loss, chunk->block, samples, b, errors);
        if (laws != NULL) chunk->sum += laws_add(laws, chunk->block, b, samples_in_block(samples, b), errors);
        if (!with_gradient) continue;
        network_backward(chunk->block, parameters);
        network_add_gradient(chunk->block, chunk->gradient);
    }
}

static double sum_chunks(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters,
                         bool with_gradient) {
    /* With less than one block per chunk, waking threads costs more than it saves. */
#pragma omp parallel for schedule(dynamic, 1) if (samples->blocks >= loss->chunk_count)
    for (int c = 0; c < loss->chunk_count; c++)
        sum_chunk(loss, &loss->chunks[c], samples, laws, c, parameters, with_gradient);
    double sum = 0;
    for (int c = 0; c < loss->chunk_count; c++) sum += loss->chunks[c].sum;
    return sum / ((double)samples->rows * loss->outputs);
}

double loss_value(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters) {
    return sum_chunks(loss, samples, laws, parameters, false);
}

double loss_gradient(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters, double *gradient) {
    double value = sum_chunks(loss, samples, laws, parameters, true);
    /* 2: the chunks summed half slopes. */
    double factor = 2 / ((double)samples->rows * loss->outputs);
    for (int p = 0; p < loss->parameters; p++) {
        double sum = 0;
        for (int c = 0; c < loss->chunk_count; c++) sum += loss->chunks[c].gradient[p];
        gradient[p] = factor * sum;
    }
    return value;
}

void loss_residuals(Loss *loss, const Samples *samples, const double *parameters, double *residuals) {
#pragma omp parallel for schedule(dynamic, 1) if (samples->blocks >= loss->chunk_count)
    for (int c = 0; c < loss->chunk_count; c++)
        for (int64_t b = chunk_start(loss, samples, c); b < chunk_start(loss, samples, c + 1); b++) {
            loss_forward(loss->chunks[c].block, samples, b, parameters);
            block_errors(loss, loss->chunks[c].block, samples, b, residuals + b * loss->outputs * BLOCK_ROWS);
        }
}

double loss_of_constant(const Loss *loss, const Samples *samples, const double *constant) {
    double sum = 0;
    for (int64_t b = 0; b < samples->blocks; b++)
        for (int k = 0; k < samples->outputs; k++)
            for (int r = 0; r < samples_in_block(samples, b); r++) {
                double error = (double)samples->y[(b * samples->outputs + k) * BLOCK_ROWS + r] - constant[k];
                sum += error_loss(&error, loss->thresholds[k]);
            }
    return sum / ((double)samples->rows * samples->outputs);
}

bool training_check(const Dataset *dataset, const TrainingOptions *options, Error *error) {
    const Network *start = options->start;
    if (options->layers < 1 || options->layers > NETWORK_MAX_LAYERS)
        return error_input(error, "layers", "must be 1 to %d weight layers (got %d)", NETWORK_MAX_LAYERS,
                           options->layers);
    const int first = options->widths[0], last = options->widths[options->layers];
    if (first != dataset_inputs(dataset))
        return error_input(error, "layers", "the first width must be %d, the inputs of a pair (got %d)",
                           dataset_inputs(dataset), first);
    if (pair_output_names(dataset->view, dataset->target, last) == NULL)
        return error_input(
            error, "layers", "for the target %s the last width must be %s (got %d)", pair_target_names[dataset->target],
            dataset->target == TARGET_POINTS ? "4 (both points)" : "2 (relative velocity) or 6 (both bodies)", last);
    if (options->iterations < 0)
        return error_input(error, "iterations", "must be 0 or more (got %d)", options->iterations);
    int64_t test_rows = 0;
    for (int64_t row = 0; row < dataset->rows; row++) test_rows += dataset_is_test(dataset, row);
    if (test_rows == 0 || test_rows == dataset->rows)
        return error_input(error, "dataset", "needs at least one training row and one test row (got %lld and %lld)",
                           (long long)(dataset->rows - test_rows), (long long)test_rows);
    if (law_weights_any(&options->laws) && !laws_check(dataset, last, &options->laws, error)) return false;
    if (start == NULL) return true;
    if (strcmp(start->inputs, pair_views[dataset->view].inputs) != 0)
        return error_input(error, "dataset", "the start network was trained on other inputs (%.80s)", start->inputs);
    if (strcmp(start->target, pair_target_names[dataset->target]) != 0)
        return error_input(error, "dataset", "the start network was trained for another target (%.80s)", start->target);
    bool fits = start->layers == options->layers;
    for (int l = 0; fits && l <= options->layers; l++) fits = start->widths[l] == options->widths[l];
    if (!fits) return error_input(error, "layers", "the start network has other widths");
    return network_config_matches(start, options, error);
}
