/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loss of a form of sain and its slopes, in double: forward and backward through the object network, the sums of
   effects and the relation network. */
#pragma once
#include "network/network_gradient.h"
#include "relation_training/relation_samples.h"

/* Weights of a form as one vector: those of the relation network, then of the object network. */
int relation_weight_count(const RelationNetwork *network);

/* Work space of one thread; zero-initialise. */
typedef struct RelationLoss {
    const RelationNetwork *network; /* shapes and normalisation of inputs; its weights are not used */
    NetworkBlock **relation;        /* [block_count] */
    NetworkBlock *object;
    double *slopes; /* [RELATION_OBJECT_INPUTS, BLOCK_ROWS] */
    int block_count;
    size_t block_capacity;
} RelationLoss;

/* The network must outlive it. */
bool relation_loss_begin(RelationLoss *loss, const RelationNetwork *network, Error *error);
void relation_loss_free(RelationLoss *loss);

/* A part of a batch: at most BLOCK_ROWS samples. */
typedef struct RelationPart {
    const RelationSamples *samples;
    const int *items; /* [count] */
    int count;
} RelationPart;

/* Answers to a part: object->values of its last layer, [RELATION_OUTPUTS, BLOCK_ROWS]. False when memory is short. */
bool relation_loss_forward(RelationLoss *loss, const RelationPart *part, const double *weights);

/* The sum over the part of a smooth L1 loss of velocity errors, m/s. Adds its slopes to gradient[weights]. False when
   memory is short. */
bool relation_loss_add(RelationLoss *loss, const RelationPart *part, const double *weights, double *sum,
                       double *gradient);
