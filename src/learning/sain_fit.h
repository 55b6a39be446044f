/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fit of sain: samples, the loss and its slopes, steps of Adam, errors on other samples.

       sain_normalise(network, &samples), sain_set_ranges(network, &samples);
       sain_first_weights(network, seed, adam.weights);
       sain_fit_begin(&fit, network, &samples, batch, error);
       sain_fit_step(&fit, &adam, seed, number, rate, &loss, error); ... sain_fit_free(&fit); */
#pragma once
#include "base/base.h"
#include "learning/learning.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"

/* What a network sees of a receiver in a recorded step, and the correction that would make its velocity converged. */
typedef struct SainSample {
    int first, rows; /* in rows */
    float body[SAIN_BODY_INPUTS];
    float target[SAIN_OUTPUTS]; /* m/s, in the receiver's frame; spin times the radius of gyration */
    float scale;                /* m/s: of the outputs */
} SainSample;

typedef struct SainRowInputs {
    float numbers[SAIN_PAIR_INPUTS];
} SainRowInputs;

/* Zero-initialise. */
typedef struct SainSamples {
    SainSample *items;
    SainRowInputs *rows;
    size_t count, row_count, problems;
    size_t unconverged; /* problems left out, as the reference did not converge */
    size_t item_capacity, row_capacity;
} SainSamples;

void sain_samples_free(SainSamples *samples);

/* Normalises the inputs to the samples' mean and standard deviation. */
void sain_normalise(SainNetwork *network, const SainSamples *samples);

/* Sets ranges and limits to those of the samples, a little widened. */
void sain_set_ranges(SainNetwork *network, const SainSamples *samples);

/* Weights as one vector: those of the relation network, then of the object network. */
int sain_weight_count(const SainNetwork *network);

/* First weights: small random ones; an object network that answers almost 0. */
void sain_first_weights(const SainNetwork *network, uint64_t seed, double *weights);

/* Rounds the weights into the network, as a file would. */
void sain_set_weights(SainNetwork *network, const double *weights);

/* Loss and slopes in double: forward and backward through the object network, the sums of effects and the relation
   network. Work space of one thread; zero-initialise. */
typedef struct SainLoss {
    const SainNetwork *network; /* shapes and normalisation of inputs; its weights are not used */
    NetworkBlock **relation;    /* [block_count] */
    NetworkBlock *object;
    double *slopes; /* [SAIN_OBJECT_INPUTS, BLOCK_ROWS] */
    int block_count;
    size_t block_capacity;
} SainLoss;

/* The network must outlive it. */
bool sain_loss_begin(SainLoss *loss, const SainNetwork *network, Error *error);
void sain_loss_free(SainLoss *loss);

/* A part of a batch: at most BLOCK_ROWS samples. */
typedef struct SainPart {
    const SainSamples *samples;
    const int *items; /* [count] */
    int count;
} SainPart;

/* The sum over the part of a smooth L1 loss of velocity errors, m/s. Adds its slopes to gradient[weights]. False when
   memory is short. */
bool sain_loss_add(SainLoss *loss, const SainPart *part, const double *weights, double *sum, double *gradient);

enum { SAIN_PARTS = 4 }; /* of a batch; each is summed by itself, so that threads do not change the sum */

/* Work space; zero-initialise. */
typedef struct SainFit {
    const SainSamples *samples;
    SainNetwork *network;
    SainLoss losses[SAIN_PARTS];
    double *gradients; /* [SAIN_PARTS, weights] */
    int items[SAIN_PARTS][BLOCK_ROWS];
    int batch; /* samples in a step */
} SainFit;

/* The samples and the network must outlive it, and there must be samples. batch: at most SAIN_PARTS *
   BLOCK_ROWS. */
bool sain_fit_begin(SainFit *fit, SainNetwork *network, const SainSamples *samples, int batch, Error *error);
void sain_fit_free(SainFit *fit);

/* Step `number` of Adam, on samples drawn by seed and number. *loss: mean over the batch. The same bits for any number
   of threads. False when memory is short. */
bool sain_fit_step(SainFit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss, Error *error);

/* Root mean square errors of velocities over all receivers, m/s; spins times the radius of gyration. Answers that the
   method would not use (methods/sain.c) count as no correction. */
typedef struct SainErrors {
    double with, without, constant; /* the network; no correction; the mean correction of the training data */
} SainErrors;

/* The errors on other samples, of which there must be some. */
bool sain_fit_errors(SainFit *fit, const double *weights, const SainSamples *samples, SainErrors *errors, Error *error);
