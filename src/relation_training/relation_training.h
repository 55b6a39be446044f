/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains the networks of sain on launches of scenes. The target is the converged solution of a step minus the engine's,
   or minus the velocities before the step for the form without engine. The first round records launches run by the
   engine and, every second, by sweeps with momentum, which stay near the converged motion. Later rounds record launches
   run by sain with the network so far, and fit all problems so far. Sources: Ajay et al., "Combining Physical
   Simulators and Object-Based Networks for Control" (2019); Ross, Gordon, Bagnell, "A Reduction of Imitation Learning
   and Structured Prediction to No-Regret Online Learning" (2011). */
#pragma once
#include "common/progress.h"
#include "relation_training/relation_fit.h"
#include "scene/scene.h"

enum { RELATION_ROUNDS_MAX = 4, RELATION_SCENES_MAX = 8 };

typedef struct RelationScore {
    RelationForm form;
    int round;
    size_t problems, bodies; /* trained on */
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
