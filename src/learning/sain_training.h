/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: recorded launches, samples, loss, rounds. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/learning.h"
#include "learning/scene_training.h"
#include "methods/methods.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

/* Training data of a form of sain: what its network sees of each receiver in recorded problems, and the correction that
   would make its velocity converged. */

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
    SainForm form;
    SainSample *items;
    SainRowInputs *rows;
    size_t count, row_count, problems;
    size_t unconverged; /* problems left out, as the reference did not converge */
    size_t item_capacity, row_capacity;
} SainSamples;

void sain_samples_free(SainSamples *samples);

/* Appends the receivers of all problems, or of those in impact frames. False with error set when memory is short. */
bool sain_samples_add(SainSamples *samples, const ImpactProblems *problems, bool impacts_only, Error *error);

/* Loss of a form of sain and its slopes, in double: forward and backward through the object network, the sums of
   effects and the relation network. */

/* Weights of a form as one vector: those of the relation network, then of the object network. */
int sain_weight_count(const SainNetwork *network);

/* Work space of one thread; zero-initialise. */
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

/* Fits the network of a form of sain to samples by Adam (learning/learning.h). */

enum { SAIN_PARTS = 4 }; /* of a batch; each is summed by itself, so that threads do not change the sum */

/* Root mean square errors of velocities over all receivers, m/s; spins times the radius of gyration. Answers that the
   method would not use (methods/sain.c) count as no correction. */
typedef struct SainErrors {
    double with, without, constant; /* the network; no correction; the mean correction of the training data */
} SainErrors;

/* Work space; zero-initialise. */
typedef struct SainFit {
    const SainSamples *samples;
    SainNetwork *network;
    SainLoss losses[SAIN_PARTS];
    double *gradients; /* [SAIN_PARTS, weights] */
    int items[SAIN_PARTS][BLOCK_ROWS];
    int batch; /* samples in a step */
} SainFit;

/* Normalises the inputs to the samples' mean and standard deviation. */
void sain_normalise(SainNetwork *network, const SainSamples *samples);

/* Sets ranges and limits to those of the samples, a little widened. */
void sain_set_ranges(SainNetwork *network, const SainSamples *samples);

/* First weights: small random ones; an object network that answers almost 0. */
void sain_first_weights(const SainNetwork *network, uint64_t seed, double *weights);

/* Rounds the weights into the network, as a file would. */
void sain_set_weights(SainNetwork *network, const double *weights);

/* The samples and the network must outlive it, and there must be samples. batch: at most SAIN_PARTS *
   BLOCK_ROWS. */
bool sain_fit_begin(SainFit *fit, SainNetwork *network, const SainSamples *samples, int batch, Error *error);
void sain_fit_free(SainFit *fit);

/* Step `number` of Adam, on samples drawn by seed and number. *loss: mean over the batch. The same bits for any number
   of threads. False when memory is short. */
bool sain_fit_step(SainFit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss, Error *error);

/* The errors on other samples, of which there must be some; the constant predictor takes the mean of those trained
   on. */
bool sain_fit_errors(SainFit *fit, const double *weights, const SainSamples *samples, SainErrors *errors, Error *error);

/* The launches that a round of training records, of several scenes: contact problems with their converged velocities,
   all impact frames, and some of those after and of those at rest. */

/* sain with a network in memory. */
typedef struct SainDriver {
    const SainNetwork *network;
    SainForm form;
} SainDriver;

typedef struct SainLaunches {
    Scene *const *scenes;
    int scene_count;
    int launches;             /* of each scene */
    int rounds, round;        /* rounds have different launches, each over the whole family */
    bool held_out;            /* other launches than those of any round */
    const SainDriver *driver; /* NULL: the engine and, every second launch, sweeps with momentum */
} SainLaunches;

/* Appends to the problems. Omits those whose reference does not converge (to 1e-6 m/s), and counts them. A launch ends
   60 frames after its impact, or where the driver's network makes its state NaN or infinite. ERROR_INPUT: a scene's
   bomb has no family of launches, a launch starts inside a body, or a step without a driver fails. */
bool sain_launches_record(const SainLaunches *launches, ImpactProblems *problems, const Progress *progress,
                          Error *error);

/* Trains the networks of sain on launches of scenes. The target is the converged solution of a step minus the engine's,
   or minus the velocities before the step for the form without engine. The first round records launches run by the
   engine and, every second, by sweeps with momentum, which stay near the converged motion. Later rounds record launches
   run by sain with the network so far, and fit all problems so far. Sources: Ajay et al., "Combining Physical
   Simulators and Object-Based Networks for Control" (2019); Ross, Gordon, Bagnell, "A Reduction of Imitation Learning
   and Structured Prediction to No-Regret Online Learning" (2011). */

enum { SAIN_ROUNDS_MAX = 4, SAIN_SCENES_MAX = 8 };

typedef struct SainScore {
    SainForm form;
    int round;
    size_t problems, bodies; /* trained on */
    size_t unconverged;      /* problems left out of the training and of the score, as the reference did not converge */
    double loss;             /* mean over the last steps */
    SainErrors held_out;     /* impacts of other launches, all scenes */
} SainScore;

typedef struct SainTraining {
    Scene *const *scenes; /* [scene_count] each with a family of launches */
    int scene_count;
    int launches; /* of each scene and round */
    int rounds;   /* at most SAIN_ROUNDS_MAX */
    int steps;    /* of Adam, in each round */
    int batch;    /* samples of a step, at most SAIN_PARTS * BLOCK_ROWS */
    int saved;    /* the state is stored after every so many steps, and after each round */
    uint64_t seed;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists. The caller removes it once it has
                               stored the networks */
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const SainScore *score);
    void *context;
} SainTraining;

/* Fills networks, which are destroyed by the caller in any case. False with error set if a scene has no family, the
   state cannot be written or read, memory is short, or nothing was recorded. ERROR_INTERRUPTED if progress requests a
   stop: the state stays. Same bits for any number of threads, and however often it was interrupted. */
bool sain_training_run(const SainTraining *training, SainNetworks *networks, const Progress *progress, Error *error);
