/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains one predictor on windows of recorded launches, through its own predictions: the components that it predicts in a
   frame are its inputs in the next. Holden et al. 2019, section 5: windows of 32 frames, starts with noise, the error of
   components and of their change. Backpropagation through time: Werbos (1990). */
#pragma once
#include "learning/adam.h"
#include "network/network_gradient.h"
#include "subspace_training/window_scales.h"

enum {
    WINDOW_FRAMES = 32,
    WINDOW_PARTS = 2, /* of a batch, BLOCK_ROWS windows each: sums of slopes do not depend on the number of threads */
    WINDOW_BATCH = WINDOW_PARTS * BLOCK_ROWS
};

typedef struct WindowFit WindowFit;

/* data, and what it points to, outlive the fit. NULL with error set when memory is short. */
WindowFit *window_fit_create(const WindowData *data, int hidden, Error *error);
void window_fit_destroy(WindowFit *fit);

const Network *window_fit_shape(const WindowFit *fit);
const WindowScales *window_fit_scales(const WindowFit *fit);

/* The windows of a batch follow from the seed. slopes[parameters] of the mean loss, which is returned. */
double window_fit_slopes(WindowFit *fit, const double *parameters, uint64_t seed, double *slopes);

/* Weights for the start: small outputs, so that the linear term rules. */
void window_fit_begin(const WindowFit *fit, uint64_t seed, double *parameters);
