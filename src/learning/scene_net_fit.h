/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples of scene-net, its first network, and its fit through the sweeps that follow it.

       SceneNetSamples samples = {0};
       scene_net_samples_take(&samples, &recorded);                            launches.h
       SceneNet *network = scene_net_from_samples(&samples, &widths, seed, error);
       scene_net_fit(network, &samples, &fit, progress, error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/launches.h"
#include "learning/unrolled.h"
#include "methods/scene_net.h"
#include "nets/kinds.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A recorded step, and what it takes to train on it. */
typedef struct SceneNetSample {
    RecordedStep step;
    /* After scene_net_samples_look(): */
    UnrolledProblem unrolled;
    SceneView view;
    float *inputs; /* [scene_net_inputs] */
} SceneNetSample;

/* Zero-initialise. */
typedef struct SceneNetSamples {
    SceneNetSample *items;
    int count;
    size_t capacity, unconverged;
} SceneNetSamples;

/* Moves recorded steps to the end. False if out of memory. */
bool scene_net_samples_take(SceneNetSamples *samples, RecordedSteps *steps);
void scene_net_samples_free(SceneNetSamples *samples);

/* Computes the view and the network's inputs of the samples from index `first`. The inputs are valid only if the
   network has projections. */
bool scene_net_samples_look(SceneNetSamples *samples, int first, const SceneNet *network, Error *error);

/* Sets the ranges of the inputs to those of samples that were looked at, a tenth wider on both sides. */
void scene_net_set_ranges(SceneNet *network, const SceneNetSamples *samples);

/* The first network: slots, input projections (principal components, whitened), output scales, random weights. */

typedef struct SceneNetWidths {
    int state, present, warm; /* number of input components of each projection */
    int hidden;
} SceneNetWidths;

/* Makes an untrained network for samples and computes their inputs. Slots are the contacts that occur in at least 3
   samples. NULL with error set: no samples, memory, or a shape out of bounds (scene_net_create). */
SceneNet *scene_net_from_samples(SceneNetSamples *samples, const SceneNetWidths *widths, uint64_t seed, Error *error);

/* The training loss of scene-net for one sample, and its gradient.

       loss = impulse_weight * mean over present slots of smooth L1((impulse - reference impulse) / scale)
            + velocity_weight * sqrt(e^2 + 0.01^2)

   e is the RMS velocity error (methods/reference.h) after the sweeps, differentiated through them: the quantity to
   minimise. The impulse loss brings the impulses into a range from which the sweeps can converge. */

typedef struct SceneNetTask {
    double impulse_weight, velocity_weight;
    int sweeps;
    const double *factors; /* [sweeps] momentum factors */
} SceneNetTask;

/* Work space of a thread. Zero-initialise; arrays grow and are reused. */
typedef struct SceneNetLoss {
    Unrolled unrolled;
    float first[SCENE_NET_WIDTH_MAX], second[SCENE_NET_WIDTH_MAX]; /* hidden layers */
    float by_first[SCENE_NET_WIDTH_MAX], by_second[SCENE_NET_WIDTH_MAX];
    float *outputs, *by_outputs; /* [2 present slots]; by_x: derivative of the loss with respect to x */
    double *numbers;             /* start, by_start, by_velocity */
    size_t output_capacity, by_output_capacity, number_capacity;
} SceneNetLoss;

void scene_net_loss_free(SceneNetLoss *loss);

typedef struct SceneNetErrors {
    double loss, error; /* error: e, m/s */
} SceneNetErrors;

/* Adds to gradient[parameter_count] and by_factors[sweeps]. by_factors may be NULL; if gradient is NULL, only the score
   is computed. False if out of memory. */
bool scene_net_loss(SceneNetLoss *loss, const SceneNet *network, const SceneNetSample *sample, const SceneNetTask *task,
                    float *gradient, double *by_factors, SceneNetErrors *score);

/* Fits scene-net's network to samples by mini-batch Adam; the rate decays to 0 by half a cosine. Quantisation-aware:
   loss and gradient are computed with the packed rows (nets/kernels.h), the step changes the float rows, which are
   then packed again. Source: straight-through estimator, Bengio, Leonard, Courville, "Estimating or Propagating
   Gradients Through Stochastic Neurons for Conditional Computation" (2013), 4. */

typedef struct SceneNetFit {
    double impulse_weight; /* of the impulse loss */
    int impulse_epochs;    /* initial epochs with the impulse loss only */
    int epochs;            /* in total */
    double rate;           /* initial learning rate */
    bool learn_factors;    /* also fit the network's momentum factors */
    uint64_t seed;         /* of the sample order */
} SceneNetFit;

/* Changes the network's parameters and, if learn_factors, its factors. The samples have its inputs. If progress stops
   the fit, keeps the current parameters. Same bits for any number of threads. False with error set: memory, or a NaN or
   infinite loss (the message names the epoch). */
bool scene_net_fit(SceneNet *network, const SceneNetSamples *samples, const SceneNetFit *fit, const Progress *progress,
                   Error *error);

/* The mean of the samples' RMS velocity errors, m/s, after the network and its sweeps; NaN without samples. */
bool scene_net_error(const SceneNet *network, const SceneNetSamples *samples, double *mean, Error *error);
