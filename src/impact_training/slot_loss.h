/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The training loss of a slot network for one sample, and its gradient.

       loss = impulse_weight * mean over present slots of smooth L1((impulse - reference impulse) / scale)
            + velocity_weight * sqrt(e^2 + 0.01^2)

   e is the RMS velocity error (solution_error.h) after the sweeps, differentiated through them
   (impact_training/unrolled.h): the quantity to minimise. The impulse loss brings the impulses into a range from which
   the sweeps can converge. */
#pragma once
#include "impact_training/slot_samples.h"

typedef struct SlotTask {
    double impulse_weight, velocity_weight;
    int sweeps;
    const double *factors; /* [sweeps] momentum factors */
} SlotTask;

/* Work space of a thread. Zero-initialise; arrays grow and are reused. */
typedef struct SlotLoss {
    Unrolled unrolled;
    float first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX]; /* hidden layers */
    float by_first[SLOT_WIDTH_MAX], by_second[SLOT_WIDTH_MAX];
    float *outputs, *by_outputs; /* [2 present slots]; by_x: derivative of the loss with respect to x */
    double *numbers;             /* start, by_start, by_velocity */
    size_t output_capacity, by_output_capacity, number_capacity;
} SlotLoss;

void slot_loss_free(SlotLoss *loss);

typedef struct SlotScore {
    double loss, error; /* error: e, m/s */
} SlotScore;

/* Adds to gradient[parameter_count] and by_factors[sweeps]. by_factors may be NULL; if gradient is NULL, only the score
   is computed. False if out of memory. */
bool slot_loss(SlotLoss *loss, const SlotNetwork *network, const SlotSample *sample, const SlotTask *task,
               float *gradient, double *by_factors, SlotScore *score);
