/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation_training/relation_loss.h"

#include "common/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Errors count in proportion to the scale of the outputs, so that a box at rest, which must not creep, counts as much
   as one in a crash; `slow` (m/s) is added to the scale. Below `smooth_below` by their square, as in Ajay et al., above
   by their size: a few crashes would outweigh all else. */
static const double slow = 0.2, smooth_below = 1;

int relation_weight_count(const RelationNetwork *network) {
    return network_parameter_count(network->relation) + network_parameter_count(network->object);
}

bool relation_loss_begin(RelationLoss *loss, const RelationNetwork *network, Error *error) {
    loss->network = network;
    loss->object = network_block_create(network->object, error);
    if (loss->object == NULL) return false;
    loss->slopes = calloc((size_t)RELATION_OBJECT_INPUTS * BLOCK_ROWS, sizeof *loss->slopes);
    return loss->slopes != NULL || error_memory(error, "sain");
}

void relation_loss_free(RelationLoss *loss) {
    for (int i = 0; i < loss->block_count; i++) network_block_destroy(loss->relation[i]);
    network_block_destroy(loss->object);
    free(loss->relation);
    free(loss->slopes);
    *loss = (RelationLoss){0};
}

static int row_count(const RelationPart *part) {
    int rows = 0;
    for (int i = 0; i < part->count; i++) rows += part->samples->items[part->items[i]].rows;
    return rows;
}

static bool reserve_blocks(RelationLoss *loss, int blocks) {
    Error error = {0};
    if (!array_reserve((void **)&loss->relation, &loss->block_capacity, (size_t)blocks, sizeof *loss->relation))
        return false;
    while (loss->block_count < blocks) {
        NetworkBlock *block = network_block_create(loss->network->relation, &error);
        if (block == NULL) return false;
        loss->relation[loss->block_count++] = block;
    }
    return true;
}

/* What normalises inputs, and the ranges that they are moved into; NULL: they stay. */
typedef struct Inputs {
    const Normalisation *by;
    const float *low, *high;
} Inputs;

static void normalise(double *values, int row, const float *numbers, int count, const Inputs *inputs) {
    for (int i = 0; i < count; i++) {
        float x = numbers[i];
        if (inputs->low != NULL) x = x < inputs->low[i] ? inputs->low[i] : x > inputs->high[i] ? inputs->high[i] : x;
        values[i * BLOCK_ROWS + row] = ((double)x - (double)inputs->by->offset[i]) * (double)inputs->by->scale[i];
    }
}

/* As at run time, for the form without an engine. Samples that are trained on are within the ranges anyway. */
static bool moves_into_ranges(const RelationPart *part) { return part->samples->form == RELATION_ALONE; }

/* The effects of row r of the part. */
static double *effects_of(const RelationLoss *loss, int r) {
    const NetworkBlock *block = loss->relation[r / BLOCK_ROWS];
    return block->values[block->shape->layers] + r % BLOCK_ROWS;
}

static void fill_rows(RelationLoss *loss, const RelationPart *part) {
    const RelationNetwork *network = loss->network;
    const bool moves = moves_into_ranges(part);
    const Inputs inputs = {&network->relation->input, moves ? network->pair_low : NULL, network->pair_high};
    int r = 0;
    for (int i = 0; i < part->count; i++) {
        const RelationSample *sample = &part->samples->items[part->items[i]];
        for (int k = 0; k < sample->rows; k++, r++)
            normalise(loss->relation[r / BLOCK_ROWS]->values[0], r % BLOCK_ROWS,
                      part->samples->rows[sample->first + k].numbers, RELATION_PAIR_INPUTS, &inputs);
    }
}

/* Body inputs, then sums of effects. */
static void fill_objects(RelationLoss *loss, const RelationPart *part) {
    const Normalisation *by = &loss->network->object->input;
    const bool moves = moves_into_ranges(part);
    const Inputs inputs = {by, moves ? loss->network->body_low : NULL, loss->network->body_high};
    double *values = loss->object->values[0];
    int r = 0;
    for (int i = 0; i < part->count; i++) {
        const RelationSample *sample = &part->samples->items[part->items[i]];
        normalise(values, i, sample->body, RELATION_BODY_INPUTS, &inputs);
        for (int e = 0; e < RELATION_EFFECTS; e++) {
            const int at = RELATION_BODY_INPUTS + e;
            double sum = 0;
            for (int k = 0; k < sample->rows; k++) sum += effects_of(loss, r + k)[e * BLOCK_ROWS];
            values[at * BLOCK_ROWS + i] = (sum - (double)by->offset[at]) * (double)by->scale[at];
        }
        r += sample->rows;
    }
}

bool relation_loss_forward(RelationLoss *loss, const RelationPart *part, const double *weights) {
    const int blocks = (row_count(part) + BLOCK_ROWS - 1) / BLOCK_ROWS;
    if (!reserve_blocks(loss, blocks)) return false;
    fill_rows(loss, part);
    for (int b = 0; b < blocks; b++) network_forward(loss->relation[b], weights);
    fill_objects(loss, part);
    network_forward(loss->object, weights + network_parameter_count(loss->network->relation));
    return true;
}

static double smooth(double error, double *slope) {
    const double size = fabs(error);
    if (size >= smooth_below) {
        *slope = error > 0 ? smooth_below : -smooth_below;
        return smooth_below * (size - smooth_below / 2);
    }
    *slope = error;
    return error * error / 2;
}

/* Fills the slopes of the outputs; 0 in unused rows. */
static double judge(RelationLoss *loss, const RelationPart *part) {
    const int last = loss->object->shape->layers;
    double *deltas = loss->object->deltas[last - 1], sum = 0;
    const double *outputs = loss->object->values[last];
    memset(deltas, 0, (size_t)RELATION_OUTPUTS * BLOCK_ROWS * sizeof *deltas);
    for (int i = 0; i < part->count; i++) {
        const RelationSample *sample = &part->samples->items[part->items[i]];
        const double scale = (double)sample->scale;
        for (int o = 0; o < RELATION_OUTPUTS; o++) {
            double slope;
            const double by = 1 / (scale + slow);
            sum += smooth(by * (scale * outputs[o * BLOCK_ROWS + i] - (double)sample->target[o]), &slope);
            deltas[o * BLOCK_ROWS + i] = by * scale * slope;
        }
    }
    return sum;
}

/* From the slopes of the sums to those of each row's effects. */
static void spread(RelationLoss *loss, const RelationPart *part, int blocks) {
    const Normalisation *by = &loss->network->object->input;
    const int last = loss->network->relation->layers - 1;
    for (int b = 0; b < blocks; b++)
        memset(loss->relation[b]->deltas[last], 0, (size_t)RELATION_EFFECTS * BLOCK_ROWS * sizeof(double));
    int r = 0;
    for (int i = 0; i < part->count; i++)
        for (int k = 0; k < part->samples->items[part->items[i]].rows; k++, r++)
            for (int e = 0; e < RELATION_EFFECTS; e++)
                loss->relation[r / BLOCK_ROWS]->deltas[last][e * BLOCK_ROWS + r % BLOCK_ROWS] =
                    loss->slopes[(RELATION_BODY_INPUTS + e) * BLOCK_ROWS + i] *
                    (double)by->scale[RELATION_BODY_INPUTS + e];
}

bool relation_loss_add(RelationLoss *loss, const RelationPart *part, const double *weights, double *sum,
                       double *gradient) {
    const int object = network_parameter_count(loss->network->relation),
              blocks = (row_count(part) + BLOCK_ROWS - 1) / BLOCK_ROWS;
    if (!relation_loss_forward(loss, part, weights)) return false;
    *sum += judge(loss, part);
    network_backward(loss->object, weights + object);
    network_add_gradient(loss->object, gradient + object);
    network_backward_to_inputs(loss->object, weights + object, loss->slopes);
    spread(loss, part, blocks);
    for (int b = 0; b < blocks; b++) {
        network_backward(loss->relation[b], weights);
        network_add_gradient(loss->relation[b], gradient);
    }
    return true;
}
