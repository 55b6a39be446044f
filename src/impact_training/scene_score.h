/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How good a network of a scene is, beside what costs no training. */
#pragma once
#include "impact_training/slot_samples.h"

typedef struct SceneScore {
    int round, samples;
    double train, held_out; /* m/s, mean error after the network and its sweeps; held-out: of launches kept apart */
    double momentum;        /* the held-out ones by momentum with 20 sweeps from the cached start */
} SceneScore;

/* Fills all but the round. Both sets of samples have been shown to the network; NAN for a set without any. */
bool scene_score(const SlotNetwork *network, const SlotSamples *samples, const SlotSamples *held_out, SceneScore *score,
                 Error *error);
