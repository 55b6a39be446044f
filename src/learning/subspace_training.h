/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of subspace: components of recorded launches, windows of frames, the fit of the predictors. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

#include <stdbool.h>

/* Recorded launches as numbers and as components (nets/kinds.h). Holden et al. 2019, section 4.1. */

/* States of launches from one step before the bomb appears on: that first state is where the bodies come from, by their
   velocities. */
typedef struct PoseRows {
    int launches, states, numbers; /* states of each launch; numbers: 4 bodies */
    float *rows;                   /* [launches, states, numbers] */
    float *launch;                 /* [launches, SUBSPACE_LAUNCH] */
} PoseRows;

bool pose_rows_make(PoseRows *rows, const Scene *scene, const LaunchRuns *runs, Error *error);
void pose_rows_free(PoseRows *rows);

static inline const float *pose_row(const PoseRows *rows, int launch, int state) {
    return rows->rows + ((size_t)launch * (size_t)rows->states + (size_t)state) * (size_t)rows->numbers;
}

/* Fills rest and basis of a net. poses[bodies of the scene]: where they rest without a bomb; the rest of the bomb is
   the mean of its rows. */
bool pose_components_fit(const PoseRows *rows, const Scene *scene, const BodyPose *poses, SubspaceNet *net,
                         Error *error);

/* components[launches, states, components of the net] of all rows; fills low and high. */
void pose_components_project(const PoseRows *rows, SubspaceNet *net, float *components);

/* What the training of a predictor takes from the recorded launches alone: its linear term, and the scales of its
   inputs and outputs. Holden et al. 2019, section 5. */

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

/* Writes the linear term and a network of two hidden layers (in the order of NetworkBlock's parameters), with the
   scales in its weights, to a predictor of the same sizes. */
void window_scales_store(const WindowData *data, const WindowScales *scales, const double *parameters,
                         SubspacePredictor *predictor);

/* How far a predictor's runs end up from recorded ones, beside what no predictor of so many components can avoid. */

#define SUBSPACE_APART 0.1 /* m */

typedef struct SubspaceErrors {
    double rms; /* m: distance of a body's position from the recorded, root mean square over bodies, frames, launches */
    double frames; /* until a body is further than SUBSPACE_APART from the recorded, median over the launches */
} SubspaceErrors;

typedef struct SubspaceScore {
    int components;
    SubspaceErrors floor;  /* of the recorded poses, projected and reconstructed */
    SubspaceErrors linear; /* of runs by the linear term alone */
    SubspaceErrors net;    /* of runs with the network */
} SubspaceScore;

/* Runs the launches of `rows` from their first two states on. False with error set when memory is short. */
bool subspace_score(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows,
                    SubspaceScore *score, Error *error);

/* How far other runs of the same launches end up from the recorded ones. */
bool subspace_distance(const PoseRows *rows, const PoseRows *others, SubspaceErrors *errors, Error *error);

/* Trains one predictor on windows of recorded launches, through its own predictions: the components that it predicts in
   a frame are its inputs in the next. Holden et al. 2019, section 5: windows of 32 frames, starts with noise, the error
   of components and of their change. Backpropagation through time: Werbos (1990). */

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

/* Trains the networks of `subspace` for a scene: records training launches by an offline engine, finds their principal
   components, fits the linear terms, then trains a network for each number of components. Source: Holden et al. 2019
   (nets/kinds.h). */

typedef struct SubspaceTraining {
    int launches; /* recorded for training */
    int epochs;   /* for each network */
    int batches;  /* of an epoch, WINDOW_BATCH windows each */
    int hidden;   /* width of the hidden layers, a multiple of ROW_LANES */
    uint64_t seed;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists; the caller removes it once it has
                               stored the networks */
    /* Called after each network with its errors on held-out launches; may be NULL. */
    void (*on_score)(void *context, const SubspaceScore *score, double loss);
    void *context;
} SubspaceTraining;

enum { SUBSPACE_HELD_OUT = 20 }; /* launches */

/* The method that the launches are recorded with. */
#define SUBSPACE_OFFLINE "interior:near=0.001"

/* Records launches[count] by a method and turns them into rows. Free them in any case. */
bool subspace_record(PoseRows *rows, const Scene *scene, const char *method, const Launch *launches, int count,
                     const Progress *progress, Error *error);

/* NULL with error set if the scene has no family of launches or too many bodies, a run fails, the state cannot be
   written or read, or memory is short; ERROR_INTERRUPTED if progress requests a stop: the state stays. Same bits for
   any number of threads, and however often it was interrupted. */
SubspaceNet *subspace_train(const Scene *scene, const SubspaceTraining *training, const Progress *progress,
                            Error *error);
