/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the training of scene-net. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/scene_training.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

/* Products C Q of directions Q with the covariance C of the columns of n sparse rows A:

       C Q = A^T (A Q - 1 mean^T Q) / n - mean (sum of the rows of (A Q - 1 mean^T Q))^T / n

   C is never formed. The mean is subtracted from the products A Q and not from the rows, which would lose their
   sparsity. The last term is 0 except for rounding errors, which it cancels if the mean is large. Own code:
   GSL's sparse matrices are in double, multiply a single vector at a time and use one thread; here the bits are the
   same for any number of threads (tests/learning/test_principal.c). */

/* Compressed sparse rows: row i has value[k] in column[k] for begin[i] <= k < begin[i + 1], in any order, each column
   at most once. */
typedef struct SparseRows {
    int rows, columns;
    const int64_t *begin;  /* [rows + 1] */
    const int32_t *column; /* [begin[rows]] */
    const float *value;
} SparseRows;

enum { DIRECTIONS_BLOCK = 16 }; /* directions per pass over the rows: small enough for the cache */

typedef struct SparseCovariance {
    const SparseRows *rows;
    size_t columns, width; /* width: number of directions, a multiple of DIRECTIONS_BLOCK */
    double *mean;          /* [columns], and the block of all arrays */
    bool *constant;        /* [columns] same value in every row */
    double *centre;        /* [width] mean^T Q */
    double *parts;         /* [parts, columns + 1, width] partial sums of A^T (...); last row: sums of (...) */
} SparseCovariance;

/* Checks the rows and computes their mean; the rows must outlive the covariance. ERROR_INPUT, naming row and column, if
   a column is out of bounds or repeated in a row or a value is not finite; must be freed on failure too. */
bool sparse_covariance_make(SparseCovariance *covariance, const SparseRows *rows, size_t width, Error *error);
void sparse_covariance_free(SparseCovariance *covariance);

/* image = C directions, both [columns, width]; exactly 0 in constant columns. Same bits for any number of threads. */
void sparse_covariance_multiply(SparseCovariance *covariance, const double *directions, double *image);

static inline void add_scaled(double *restrict sums, double scale, const double *restrict numbers, size_t count) {
    for (size_t i = 0; i < count; i++) sums[i] += scale * numbers[i];
}

/* Whitened principal components of sparse rows, the inputs of scene-net's network (nets/kinds.h). Source: Halko,
   Martinsson, Tropp, "Finding Structure with Randomness" (2011), algorithm 4.4, randomised subspace iteration. */

/* Fits a projection, allocated by the caller with from = columns and to = number of components. Over the rows,
   components have mean 0, variance 1 (divisor: number of rows) and no correlation, strongest first. The largest entry
   of each direction is positive. Components beyond the rank, or with less than 1e-10 of the largest variance, are
   always 0; constant columns contribute nothing. Same bits for any number of threads.

   Whitening is always exact. If the variances decay slowly beyond the last component, the directions are not exactly
   the strongest ones, but explain nearly as much variance.

   ERROR_INPUT if there are no rows, a column is out of bounds or repeated in a row, or a value is not finite; the
   projection is then unchanged. */
bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error);

/* The training loss of scene-net for one sample, and its gradient.

       loss = impulse_weight * mean over present slots of smooth L1((impulse - reference impulse) / scale)
            + velocity_weight * sqrt(e^2 + 0.01^2)

   e is the RMS velocity error (methods/reference.h) after the sweeps, differentiated through them
   (learning/scene_training.h): the quantity to minimise. The impulse loss brings the impulses into a range from which
   the sweeps can converge. */

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

/* Steps of launches. */

/* The world of the scene just before the bomb is added, which all launches share. */
World *launch_prefix(const Scene *scene, const ContactSolver *solver, Error *error);

/* Sees the contact problem of a step after the step; since: steps since the bomb's first touch. */
typedef bool LaunchSee(void *context, const ContactProblem *problem, Phase phase, int since, Error *error);

/* Runs a launch from that world on, up to `steps` steps from the bomb's first touch, which are its impact phase. Ends
   if the state becomes NaN or infinite. */
bool launch_run(const Scene *scene, const Launch *launch, const World *prefix, const ContactSolver *solver, int steps,
                LaunchSee *see, void *context, Error *error);

/* Runs launches of a scene with a given solver and records the contact problems of their impacts: the steps after the
   bomb's first touch in which the residual of the warm start reaches the gate (methods/residual.h). */

typedef struct SceneNetRollout {
    const Scene *scene;
    const Launch *launches; /* [launch_count] */
    int launch_count;       /* the bomb's frame must be the scene's in all launches */
    int first_launch;       /* SceneNetSample.launch of the first launch */
    int steps;              /* examined from the first touch */
    float gate;             /* m/s */
    /* Makes the solver of a launch; scene_net_rollout() destroys it. */
    bool (*make_solver)(void *context, ContactSolver *solver, Error *error);
    void *context;
} SceneNetRollout;

/* Appends to the samples in the order of launches and steps, for any number of threads. A launch ends if its state
   becomes NaN or infinite. */
bool scene_net_rollout(const SceneNetRollout *rollout, SceneNetSamples *samples, const Progress *progress,
                       Error *error);

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

/* Changes the network's parameters and, if learn_factors, its factors. The samples have its inputs
   (scene_net_samples_compute_inputs). If progress stops the fit, keeps the current parameters. Same bits for any number
   of threads. False with error set: memory, or a NaN or infinite loss (the message names the epoch). */
bool scene_net_fit(SceneNet *network, const SceneNetSamples *samples, const SceneNetFit *fit, const Progress *progress,
                   Error *error);

/* errors[count - first]: RMS velocity errors in m/s after the network and its sweeps, of the samples from index
   `first`. */
bool slot_errors(const SceneNet *network, const SceneNetSamples *samples, int first, double *errors, Error *error);
