/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains a network for the impacts of one scene (solvers/scene_net.c): launches are run, their impacts solved by the
   reference, the network fitted through the sweeps that follow it; then run with the network, and fitted to where that
   led as well. Source: aggregation of what the learner itself meets: Ross, Gordon, Bagnell, "A Reduction of Imitation
   Learning and Structured Prediction to No-Regret Online Learning" (2011). */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "impact_training/scene_score.h"
#include "impact_training/slot_shape.h"
#include "scene/scene.h"

typedef struct SceneTraining {
    int launches;  /* of each round: x in +-5 m; of a half, rotation in +-1.5 rad and spin in +-20 rad/s */
    int rounds;    /* the first by momentum and by the reference, the others with the network */
    int epochs;    /* of the first round; the others have half as many */
    int sweeps;    /* that follow the network */
    bool momentum; /* they have learned factors of momentum */
    SlotWidths widths;
    uint64_t seed;
    /* After each round; may be NULL. */
    void (*on_score)(void *context, const SceneScore *score);
    void *context;
} SceneTraining;

/* NULL with error set: a scene without a bomb, launches that touch nothing, memory, a loss that left the finite numbers.
   When progress asks to stop after the first round, the network as it is. `command` is left empty. The same bits at any
   number of threads. */
SlotNetwork *scene_training_run(const Scene *scene, const SceneTraining *training, const Progress *progress,
                                Error *error);
