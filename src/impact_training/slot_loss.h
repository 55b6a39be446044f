/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a slot network's answer to a sample costs, and how that changes with its parameters.

       loss = near * mean over the slots there are of smooth L1 of (impulse - the reference's) / scale
            + far  * root of (e^2 + 0.01^2), e the RMS velocity error (solution_error.h) after the sweeps

   The first term leads the impulses to where the sweeps can do something with them; alone it weighs each contact as much
   as any other. The second is what the network is for: the error that is left when the sweeps are done
   (impact_training/unrolled.h). */
#pragma once
#include "impact_training/slot_samples.h"

typedef struct SlotTask {
    double near, far;
    int sweeps;
    const double *factors; /* [sweeps] of momentum */
} SlotTask;

/* Work space of a thread. Zero-initialise; arrays grow and are reused. */
typedef struct SlotLoss {
    Unrolled unrolled;
    float first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX]; /* hidden layers */
    float by_first[SLOT_WIDTH_MAX], by_second[SLOT_WIDTH_MAX];
    float *outputs, *by_outputs; /* [2 slots there are] */
    double *numbers;             /* start, its derivative, that of the velocities */
    size_t output_capacity, by_output_capacity, number_capacity;
} SlotLoss;

void slot_loss_free(SlotLoss *loss);

typedef struct SlotScore {
    double loss, error; /* error: m/s, after the sweeps */
} SlotScore;

/* gradient [parameter_count] and by_factors [sweeps] are added to; NULL: only the score. False when memory is short. */
bool slot_loss(SlotLoss *loss, const SlotNetwork *network, const SlotSample *sample, const SlotTask *task,
               float *gradient, double *by_factors, SlotScore *score);
