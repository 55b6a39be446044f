/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of scene-net: a network for the impacts of one scene (methods/scene_net.c). The first round runs launches,
   solves their impacts by the reference and fits the network through the sweeps that follow it. Later rounds run
   launches with the network and fit it to the aggregated impacts (DAgger). Source: Ross, Gordon, Bagnell, "A Reduction
   of Imitation Learning and Structured Prediction to No-Regret Online Learning" (2011).

       SceneNet *network = scene_training_run(scene, &training, progress, error);
       bool ok = network != NULL && scene_net_write(network, "net.npz", error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/scene_net_fit.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

/* Errors of the network and of its untrained baseline after a round. */
typedef struct SceneNetScore {
    int round, samples;
    int unconverged; /* impacts left out so far, as the reference did not converge */
    double train,
        held_out;    /* m/s: mean error of network + sweeps on training and on held-out launches; NAN: no impact */
    double momentum; /* m/s: mean error of momentum with 20 sweeps and warm start, held-out launches */
} SceneNetScore;

typedef struct SceneTraining {
    int launches;  /* per round, drawn from the scene's family; half of them with a random rotation and spin */
    int rounds;    /* the first is run by momentum and by the reference, the others by the network */
    int epochs;    /* of the first round; later rounds have half as many */
    int sweeps;    /* after the network */
    bool momentum; /* learn momentum factors for the sweeps */
    SceneNetWidths widths;
    uint64_t seed;
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const SceneNetScore *score);
    void *context;
} SceneTraining;

/* NULL with error set: a scene without a bomb or with one x, launches that touch nothing, memory, a loss that is NaN
   or infinite. If progress stops the training after the first network was made, returns the network as it is.
   `command` is left empty. Same bits for any number of threads. */
SceneNet *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress, Error *error);
