/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One predictor of subspace: its linear term, its scales, and a network that is trained through its own predictions.

       window_linear(&data, linear);
       WindowFit *fit = window_fit_create(&data, 64, error);
       window_fit_begin(fit, seed, parameters);
       loss = window_fit_slopes(fit, parameters, batch, slopes); ... window_fit_store(fit, parameters, predictor);

   The components that the predictor predicts in a frame are its inputs in the next. Holden et al. 2019, section 5:
   windows of 32 frames, starts with noise, the error of components and of their change. Backpropagation through time:
   Werbos (1990). */
#pragma once
#include "base/base.h"
#include "nets/kinds.h"
#include "nets/nets.h"

/* Recorded launches as numbers (nets/kinds.h), from one step before the bomb appears on: that first state is where the
   bodies come from, by their velocities. Holden et al. 2019, section 4.1. */
typedef struct PoseRows {
    int launches, states, numbers; /* states of each launch; numbers: 4 bodies */
    float *rows;                   /* [launches, states, numbers] */
    float *launch;                 /* [launches, SUBSPACE_LAUNCH] */
} PoseRows;

static inline const float *pose_row(const PoseRows *rows, int launch, int state) {
    return rows->rows + ((size_t)launch * (size_t)rows->states + (size_t)state) * (size_t)rows->numbers;
}

/* What a predictor is trained on. */
typedef struct WindowData {
    const PoseRows *rows;
    const float *components; /* [launches, states, stride] */
    int stride, count;       /* components of the basis, and of the predictor */
    const double *linear;    /* [2, count] a, b */
    const float *low, *high; /* [count] */
} WindowData;

/* z -> z * scale: what the network sees has a root mean square of about 1, and so has what it must predict. */
typedef struct WindowScales {
    double value[SUBSPACE_COMPONENTS_MAX], change[SUBSPACE_COMPONENTS_MAX]; /* of inputs */
    double output[SUBSPACE_COMPONENTS_MAX];                                 /* of outputs: z units per unit */
    double launch_offset[SUBSPACE_LAUNCH], launch[SUBSPACE_LAUNCH];
    double noise[SUBSPACE_COMPONENTS_MAX], change_noise[SUBSPACE_COMPONENTS_MAX]; /* m: of the start of a window */
} WindowScales;

enum {
    WINDOW_FRAMES = 32,
    WINDOW_PARTS = 2, /* of a batch, BLOCK_ROWS windows each: sums of slopes do not depend on the number of threads */
    WINDOW_BATCH = WINDOW_PARTS * BLOCK_ROWS
};

/* Least squares of z' = a z + b z_before over all rows, for each component by itself. linear[2, count] */
void window_linear(const WindowData *data, double *linear);

typedef struct WindowPart WindowPart;

typedef struct WindowFit {
    const WindowData *data;
    Network *shape; /* two hidden layers */
    WindowScales scales;
    WindowPart *parts[WINDOW_PARTS];
} WindowFit;

/* data, and what it points to, outlive the fit. NULL with error set when memory is short. */
WindowFit *window_fit_create(const WindowData *data, int hidden, Error *error);
void window_fit_destroy(WindowFit *fit);

/* Weights for the start: small outputs, so that the linear term rules. */
void window_fit_begin(const WindowFit *fit, uint64_t seed, double *parameters);

/* The windows of a batch follow from the seed. slopes[parameters] of the mean loss, which is returned. */
double window_fit_slopes(WindowFit *fit, const double *parameters, uint64_t seed, double *slopes);

/* Writes the linear term and the network (parameters in the order of NetworkBlock's), with the scales in its weights,
   to a predictor of the same sizes. */
void window_fit_store(const WindowFit *fit, const double *parameters, SubspacePredictor *predictor);
