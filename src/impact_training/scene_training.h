/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains a network for the impacts of one scene (solvers/scene_net.c). The first round runs launches, solves their
   impacts by the reference and fits the network through the sweeps that follow it. Later rounds run launches with the
   network and fit it to the aggregated impacts (DAgger). Source: Ross, Gordon, Bagnell, "A Reduction of Imitation
   Learning and Structured Prediction to No-Regret Online Learning" (2011). */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "impact_training/scene_net_score.h"
#include "impact_training/scene_net_verdict.h"
#include "impact_training/slot_network_init.h"
#include "pieces/pieces.h"
#include "scene/scene.h"

typedef struct SceneTraining {
    int launches;  /* per round, drawn from the scene's family; half of them with a random rotation and spin */
    int rounds;    /* the first is run by momentum and by the reference, the others by the network */
    int epochs;    /* of the first round; later rounds have half as many */
    int sweeps;    /* after the network */
    bool momentum; /* learn momentum factors for the sweeps */
    SlotWidths widths;
    uint64_t seed;
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const SceneNetScore *score);
    void *context;
    SceneNetVerdict *verdict; /* on the network that is returned; or NULL */
    const Pieces *recorded;   /* what the first round runs is read from these (scene_recording.h); or NULL */
} SceneTraining;

/* NULL with error set: a scene without a bomb or with one x, launches that touch nothing, memory, a loss that is NaN
   or infinite. If progress stops the training after the first network was made, returns the network as it is.
   `command` is left empty. Same bits for any number of threads. */
SlotNetwork *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress,
                                Error *error);
