/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of the network of sain on launches of scenes. The target is the converged solution of a step minus the
   engine's. The first round records launches run by the engine and, every second, by sweeps with momentum, which stay near the converged motion. Later rounds record
   launches run by sain with the network so far, and fit all problems so far. Sources: Ajay et al., "Combining Physical
   Simulators and Object-Based Networks for Control" (2019); Ross, Gordon, Bagnell, "A Reduction of Imitation Learning
   and Structured Prediction to No-Regret Online Learning" (2011).

       SainNetwork network;
       bool ok = sain_training_run(&training, &network, progress, error) &&
                 sain_network_write(&network, "net.npz", error); ... sain_network_destroy(&network); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/launches.h"
#include "learning/sain_fit.h"
#include "methods/sain.h"
#include "scenes/scenes.h"

enum { SAIN_ROUNDS_MAX = 4, SAIN_SCENES_MAX = 8 };

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

/* Fills the network, which is destroyed by the caller in any case. False with error set if a scene has no family, memory
   is short, or nothing was recorded. If progress requests a stop, the network is that so far; ERROR_INTERRUPTED if
   there is none. Same bits for any number of threads. */
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

/* Appends the receivers of all steps, or of those in impact frames. False with error set when memory is short. */
bool sain_samples_add(SainSamples *samples, const RecordedSteps *steps, bool impacts_only, Error *error);
