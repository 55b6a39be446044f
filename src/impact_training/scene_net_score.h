/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors of a scene network and of its untrained baseline. */
#pragma once
#include "impact_training/slot_samples.h"

typedef struct SceneNetScore {
    int round, samples;
    double train, held_out; /* m/s: mean error of network + sweeps on training and on held-out launches */
    double momentum;        /* m/s: mean error of momentum with 20 sweeps and warm start, held-out launches */
} SceneNetScore;

/* Fills all except `round`; NaN for an empty set. Both sets have the network's inputs (slot_samples_compute_inputs). */
bool scene_net_score(const SlotNetwork *network, const SlotSamples *samples, const SlotSamples *held_out,
                     SceneNetScore *score, Error *error);
