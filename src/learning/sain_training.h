/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of the network of sain on launches of scenes. The target is the converged solution of a step minus the
   engine's. The first round records launches run by the engine and, every second, by sweeps with momentum, which stay
   near the converged motion. Later rounds record launches run by sain with the network so far, and fit all problems so
   far. Sources: Ajay et al., "Combining Physical Simulators and Object-Based Networks for Control" (2019); Ross,
   Gordon, Bagnell, "A Reduction of Imitation Learning and Structured Prediction to No-Regret Online Learning" (2011).

       SainNetwork network;
       bool ok = sain_training_run(&training, &network, progress, error) &&
                 sain_network_write(&network, "net.npz", error); ... sain_network_destroy(&network); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

enum {
    SAIN_ROUNDS_MAX = 4,
    SAIN_SCENES_MAX = 8,
    SAIN_PARTS = 4 /* of a batch; each is summed by itself, so that threads do not change the sum */
};

/* Root mean square errors of velocities over all receivers, m/s; spins times the radius of gyration. Answers that the
   method would not use (methods/sain.c) count as no correction. */
typedef struct SainErrors {
    double with, without, constant; /* the network; no correction; the mean correction of the training data */
} SainErrors;

typedef struct SainScore {
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
    uint64_t seed;
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const SainScore *score);
    void *context;
} SainTraining;

/* Fills the network, which is destroyed by the caller in any case. False with error set if a scene has no family,
   memory is short, or nothing was recorded. If progress requests a stop, the network is that so far; ERROR_INTERRUPTED
   if there is none. Same bits for any number of threads. */
bool sain_training_run(const SainTraining *training, SainNetwork *network, const Progress *progress, Error *error);

/* The launches that a round records, of several scenes: all impact frames, and some of those after and of those at
   rest. */
typedef struct SainLaunches {
    Scene *const *scenes;
    int scene_count;
    int launches;               /* of each scene */
    int rounds, round;          /* rounds have different launches, each over the whole family */
    bool held_out;              /* other launches than those of any round */
    const SainNetwork *network; /* that runs them; NULL: the engine and, every second launch, sweeps with momentum */
} SainLaunches;

/* Appends to the steps. Omits those whose reference does not converge (to 1e-6 m/s), and counts them. A launch ends 60
   frames after its impact, or where its network makes its state NaN or infinite. ERROR_INPUT: a scene's bomb has no
   family of launches, a launch starts inside a body, or a step without a network fails. */
bool sain_launches_record(const SainLaunches *launches, RecordedSteps *steps, const Progress *progress, Error *error);

/* What a network sees of a receiver in a recorded step, and the correction that would make its velocity converged. */
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
    SainSample *items;
    SainRowInputs *rows;
    size_t count, row_count, problems;
    size_t unconverged; /* problems left out, as the reference did not converge */
    size_t item_capacity, row_capacity;
} SainSamples;

void sain_samples_free(SainSamples *samples);

/* Appends the receivers of all steps, or of those in impact frames. False with error set when memory is short. */
bool sain_samples_add(SainSamples *samples, const RecordedSteps *steps, bool impacts_only, Error *error);

/* Sets the ranges and limits to those of the samples, a little widened. first: also normalises the inputs to the
   samples' mean and standard deviation. */
void sain_normalise(SainNetwork *network, const SainSamples *samples, bool first);

/* Weights as one vector: those of the relation network, then of the object network. */
int sain_weight_count(const SainNetwork *network);

/* First weights: small random ones; an object network that answers almost 0. */
void sain_first_weights(const SainNetwork *network, uint64_t seed, double *weights);

/* Loss and slopes in double: forward and backward through the object network, the sums of effects and the relation
   network. Work space of one thread; zero-initialise. */
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
