/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches of a training of a scene network. Those that are held out, and those of the first round, do not depend on the
   network: they can be recorded in pieces (pieces/pieces.h), and be read by the training. */
#pragma once
#include "impact_training/scene_training.h"
#include "impact_training/slot_samples.h"
#include "pieces/piece_ranges.h"
#include "scene/launch.h"

#include <gsl/gsl_rng.h>

/* RMS residual of the warm start over the contacts, m/s: below it at rest, above it during a shock. Only the latter are samples. */
#define SCENE_RECORDING_GATE 0.3f

/* Launches by who runs them. */
typedef enum SceneSet { SCENE_HELD_OUT, SCENE_BY_MOMENTUM, SCENE_BY_REFERENCE, SCENE_SETS } SceneSet;

/* scene_recording_end(). */
typedef struct SceneRecording {
    const Scene *scene;
    const SceneTraining *training;
    gsl_rng *generator; /* of the next round */
    int round;
    Launch *launches;   /* of the sets, in their order; the last two are the round's */
    PieceRanges ranges; /* a group for each set */
    PiecePlan plan;
} SceneRecording;

/* Draws the launches of the first round, and checks those of all rounds: the last round must not be the first to be refused.
   ERROR_INPUT also for a scene without a bomb or with one x. All pointers must outlive the recording, which must stay where
   it is. */
bool scene_recording_begin(SceneRecording *recording, const Scene *scene, const SceneTraining *training, Error *error);
void scene_recording_end(SceneRecording *recording);

/* Appends the labelled samples of a set, in the order of launches: from training->recorded, or by running them. */
bool scene_recording_take(const SceneRecording *recording, SceneSet set, SlotSamples *samples, const Progress *progress,
                          Error *error);

/* Draws the launches of the next round, runs them with the network and appends their labelled samples. */
bool scene_recording_next(SceneRecording *recording, const SlotNetwork *network, SlotSamples *samples,
                          const Progress *progress, Error *error);
