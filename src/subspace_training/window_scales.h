/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the training of a predictor takes from the recorded launches alone: its linear term, and the scales of its inputs
   and outputs. Holden et al. 2019, section 5. */
#pragma once
#include "subspace_training/pose_components.h"

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

static inline const float *window_state(const WindowData *data, int launch, int state) {
    return data->components + ((size_t)launch * (size_t)data->rows->states + (size_t)state) * (size_t)data->stride;
}

/* Least squares of z' = a z + b z_before over all rows, for each component by itself. linear[2, count] */
void window_linear(const WindowData *data, double *linear);

void window_scales_find(const WindowData *data, WindowScales *scales);

/* Writes the linear term and a network of two hidden layers (window_fit.h has the order of its parameters), with the scales
   in its weights, to a predictor of the same sizes. */
void window_scales_store(const WindowData *data, const WindowScales *scales, const double *parameters,
                         SubspacePredictor *predictor);
