/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits the network of a form of sain to samples by Adam (learning/adam.h). */
#pragma once
#include "learning/adam.h"
#include "relation_training/relation_loss.h"

enum { RELATION_PARTS = 4 }; /* of a batch; each is summed by itself, so that threads do not change the sum */

/* Root mean square errors of velocities over all receivers, m/s; spins times the radius of gyration. Answers that the
   method would not use (solvers/sain.c) count as no correction. */
typedef struct RelationErrors {
    double with, without, constant; /* the network; no correction; the mean correction of the training data */
} RelationErrors;

/* Work space; zero-initialise. */
typedef struct RelationFit {
    const RelationSamples *samples;
    RelationNetwork *network;
    RelationLoss losses[RELATION_PARTS];
    double *gradients; /* [RELATION_PARTS, weights] */
    int items[RELATION_PARTS][BLOCK_ROWS];
    int batch; /* samples in a step */
} RelationFit;

/* Normalises the inputs to the samples' mean and standard deviation. */
void relation_normalise(RelationNetwork *network, const RelationSamples *samples);

/* Sets ranges and limits to those of the samples, a little widened. */
void relation_set_ranges(RelationNetwork *network, const RelationSamples *samples);

/* First weights: small random ones; an object network that answers almost 0. */
void relation_first_weights(const RelationNetwork *network, uint64_t seed, double *weights);

/* Rounds the weights into the network, as a file would. */
void relation_set_weights(RelationNetwork *network, const double *weights);

/* The samples and the network must outlive it, and there must be samples. batch: at most RELATION_PARTS *
   BLOCK_ROWS. */
bool relation_fit_begin(RelationFit *fit, RelationNetwork *network, const RelationSamples *samples, int batch,
                        Error *error);
void relation_fit_free(RelationFit *fit);

/* Step `number` of Adam, on samples drawn by seed and number. *loss: mean over the batch. The same bits for any number
   of threads. False when memory is short. */
bool relation_fit_step(RelationFit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss,
                       Error *error);

/* The errors on other samples, of which there must be some; the constant predictor takes the mean of those trained
   on. */
bool relation_fit_errors(RelationFit *fit, const double *weights, const RelationSamples *samples,
                         RelationErrors *errors, Error *error);
