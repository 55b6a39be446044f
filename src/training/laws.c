/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "training/laws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static void fill(Laws *laws, const Dataset *dataset, const LawNumbers *weights) {
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
    fill(laws, dataset, weights);
    return laws;
}

void laws_destroy(Laws *laws) {
    if (laws == NULL) return;
    free(laws->rows);
    free(laws);
}

/* Half the derivative of factor * excess^2 with respect to one row's outputs; `excess` includes the factor. */
static void add_slope(const Laws *laws, double excess, const double slope[PAIR_CHANGES], double *half_slopes) {
    for (int k = 0; k < PAIR_CHANGES; k++)
        half_slopes[k * BLOCK_ROWS] += excess * slope[k] / (double)laws->network->output.scale[k];
}

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
            add_slope(laws, laws->factor[law] * excess, slope, half_slopes + r);
        }
    }
    return sum;
}

static void predicted_change(const Dataset *dataset, const Network *network, int64_t row, float *scratch,
                             double change[PAIR_CHANGES]) {
    float output[PAIR_CHANGES];
    network_predict(network, dataset->inputs + row * dataset_inputs(dataset), scratch, output);
    for (int k = 0; k < PAIR_CHANGES; k++) change[k] = (double)output[k];
}

static bool measure(const Dataset *dataset, const Network *network, float *scratch, LawNumbers *violations,
                    Error *error) {
    double change[PAIR_CHANGES], slope[PAIR_CHANGES];
    int64_t count = 0;
    *violations = (LawNumbers){{0}};
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!dataset_is_test(dataset, row)) continue;
        const LawPair pair = law_pair(dataset->context + row * PAIR_CONTEXT);
        if (network != NULL)
            predicted_change(dataset, network, row, scratch, change);
        else
            label_change(dataset, row, change);
        for (int law = 0; law < LAWS; law++) violations->of[law] += laws_known[law].violation(&pair, change, slope);
        count++;
    }
    if (count == 0) return error_input(error, "laws", "the dataset has no test rows");
    for (int law = 0; law < LAWS; law++) violations->of[law] /= (double)count;
    return true;
}

bool laws_measure(const Dataset *dataset, const Network *network, LawNumbers *violations, Error *error) {
    const LawNumbers none = {{0}};
    if (!laws_check(dataset, network != NULL ? network->widths[network->layers] : PAIR_CHANGES, &none, error))
        return false;
    if (network == NULL) return measure(dataset, NULL, NULL, violations, error);
    if (strcmp(network->inputs, pair_views[dataset->view].inputs) != 0)
        return error_input(error, "laws", "the network has other inputs (%.80s)", network->inputs);
    float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch);
    if (scratch == NULL) return error_memory(error, "laws");
    const bool ok = measure(dataset, network, scratch, violations, error);
    free(scratch);
    return ok;
}
