/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: recorded launches, samples, loss, rounds. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/learning.h"
#include "learning/scene_training.h"
#include "methods/methods.h"
#include "methods/relation_view.h"
#include "methods/sain.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

/* Training data of a form of sain: what its network sees of each receiver in recorded problems, and the correction that
   would make its velocity converged. */

typedef struct RelationSample {
    int first, rows; /* in rows */
    float body[RELATION_BODY_INPUTS];
    float target[RELATION_OUTPUTS]; /* m/s, in the receiver's frame; spin times the radius of gyration */
    float scale;                    /* m/s: of the outputs */
} RelationSample;

typedef struct RelationRowInputs {
    float numbers[RELATION_PAIR_INPUTS];
} RelationRowInputs;

/* Zero-initialise. */
typedef struct RelationSamples {
    RelationForm form;
    RelationSample *items;
    RelationRowInputs *rows;
    size_t count, row_count, problems;
    size_t unconverged; /* problems left out, as the reference did not converge */
    size_t item_capacity, row_capacity;
} RelationSamples;

void relation_samples_free(RelationSamples *samples);

/* Appends the receivers of all problems, or of those in impact frames. False with error set when memory is short. */
bool relation_samples_add(RelationSamples *samples, const ImpactProblems *problems, bool impacts_only, Error *error);

/* Loss of a form of sain and its slopes, in double: forward and backward through the object network, the sums of
   effects and the relation network. */

/* Weights of a form as one vector: those of the relation network, then of the object network. */
int relation_weight_count(const RelationNetwork *network);

/* Work space of one thread; zero-initialise. */
typedef struct RelationLoss {
    const RelationNetwork *network; /* shapes and normalisation of inputs; its weights are not used */
    NetworkBlock **relation;        /* [block_count] */
    NetworkBlock *object;
    double *slopes; /* [RELATION_OBJECT_INPUTS, BLOCK_ROWS] */
    int block_count;
    size_t block_capacity;
} RelationLoss;

/* The network must outlive it. */
bool relation_loss_begin(RelationLoss *loss, const RelationNetwork *network, Error *error);
void relation_loss_free(RelationLoss *loss);

/* A part of a batch: at most BLOCK_ROWS samples. */
typedef struct RelationPart {
    const RelationSamples *samples;
    const int *items; /* [count] */
    int count;
} RelationPart;

/* The sum over the part of a smooth L1 loss of velocity errors, m/s. Adds its slopes to gradient[weights]. False when
   memory is short. */
bool relation_loss_add(RelationLoss *loss, const RelationPart *part, const double *weights, double *sum,
                       double *gradient);

/* Fits the network of a form of sain to samples by Adam (learning/learning.h). */

enum { RELATION_PARTS = 4 }; /* of a batch; each is summed by itself, so that threads do not change the sum */

/* Root mean square errors of velocities over all receivers, m/s; spins times the radius of gyration. Answers that the
   method would not use (methods/sain.c) count as no correction. */
typedef struct RelationErrors {
    double with, without, constant; /* the network; no correction; the mean correction of the training data */
} RelationErrors;

/* Work space; zero-initialise. */
typedef struct RelationFit {
    const RelationSamples *samples;
    RelationNetwork *network;
    RelationLoss losses[RELATION_PARTS];
    double *gradients; /* [RELATION_PARTS, weights] */
    int items[RELATION_PARTS][BLOCK_ROWS];
    int batch; /* samples in a step */
} RelationFit;

/* Normalises the inputs to the samples' mean and standard deviation. */
void relation_normalise(RelationNetwork *network, const RelationSamples *samples);

/* Sets ranges and limits to those of the samples, a little widened. */
void relation_set_ranges(RelationNetwork *network, const RelationSamples *samples);

/* First weights: small random ones; an object network that answers almost 0. */
void relation_first_weights(const RelationNetwork *network, uint64_t seed, double *weights);

/* Rounds the weights into the network, as a file would. */
void relation_set_weights(RelationNetwork *network, const double *weights);

/* The samples and the network must outlive it, and there must be samples. batch: at most RELATION_PARTS *
   BLOCK_ROWS. */
bool relation_fit_begin(RelationFit *fit, RelationNetwork *network, const RelationSamples *samples, int batch,
                        Error *error);
void relation_fit_free(RelationFit *fit);

/* Step `number` of Adam, on samples drawn by seed and number. *loss: mean over the batch. The same bits for any number
   of threads. False when memory is short. */
bool relation_fit_step(RelationFit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss,
                       Error *error);

/* The errors on other samples, of which there must be some; the constant predictor takes the mean of those trained
   on. */
bool relation_fit_errors(RelationFit *fit, const double *weights, const RelationSamples *samples,
                         RelationErrors *errors, Error *error);

/* The launches that a round of training records, of several scenes: contact problems with their converged velocities, all
   impact frames, and some of those after and of those at rest. */

/* sain with a network in memory. */
typedef struct RelationDriver {
    const RelationNetwork *network;
    RelationForm form;
} RelationDriver;

typedef struct RelationLaunches {
    Scene *const *scenes;
    int scene_count;
    int launches;                 /* of each scene */
    int rounds, round;            /* rounds have different launches, each over the whole family */
    bool held_out;                /* other launches than those of any round */
    const RelationDriver *driver; /* NULL: the engine and, every second launch, sweeps with momentum */
} RelationLaunches;

/* Appends to the problems. Omits those whose reference does not converge (to 1e-6 m/s), and counts them. A launch ends
   60 frames after its impact, or where the driver's network makes its state NaN or infinite. ERROR_INPUT: a scene's bomb
   has no family of launches, a launch starts inside a body, or a step without a driver fails. */
bool relation_launches_record(const RelationLaunches *launches, ImpactProblems *problems, const Progress *progress,
                              Error *error);

/* Trains the networks of sain on launches of scenes. The target is the converged solution of a step minus the engine's,
   or minus the velocities before the step for the form without engine. The first round records launches run by the
   engine and, every second, by sweeps with momentum, which stay near the converged motion. Later rounds record launches
   run by sain with the network so far, and fit all problems so far. Sources: Ajay et al., "Combining Physical
   Simulators and Object-Based Networks for Control" (2019); Ross, Gordon, Bagnell, "A Reduction of Imitation Learning
   and Structured Prediction to No-Regret Online Learning" (2011). */

enum { RELATION_ROUNDS_MAX = 4, RELATION_SCENES_MAX = 8 };

typedef struct RelationScore {
    RelationForm form;
    int round;
    size_t problems, bodies; /* trained on */
    size_t unconverged;      /* problems left out of the training and of the score, as the reference did not converge */
    double loss;             /* mean over the last steps */
    RelationErrors held_out; /* impacts of other launches, all scenes */
} RelationScore;

typedef struct RelationTraining {
    Scene *const *scenes; /* [scene_count] each with a family of launches */
    int scene_count;
    int launches; /* of each scene and round */
    int rounds;   /* at most RELATION_ROUNDS_MAX */
    int steps;    /* of Adam, in each round */
    int batch;    /* samples of a step, at most RELATION_PARTS * BLOCK_ROWS */
    int saved;    /* the state is stored after every so many steps, and after each round */
    uint64_t seed;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists. The caller removes it once it has
                               stored the networks */
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const RelationScore *score);
    void *context;
} RelationTraining;

/* Fills networks, which are destroyed by the caller in any case. False with error set if a scene has no family, the
   state cannot be written or read, memory is short, or nothing was recorded. ERROR_INTERRUPTED if progress requests a
   stop: the state stays. Same bits for any number of threads, and however often it was interrupted. */
bool relation_training_run(const RelationTraining *training, RelationNetworks *networks, const Progress *progress,
                           Error *error);
