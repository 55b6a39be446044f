/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of subspace for a scene: records launches by an offline engine, finds their principal components, fits the
   linear terms, then trains a network for each number of components. Source: Holden et al. 2019 (nets/kinds.h).

       SubspaceNet *net = subspace_train(scene, &training, progress, error);
       bool ok = net != NULL && subspace_net_write(net, "net.npz", error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/subspace_fit.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

/* How far runs end up from recorded ones. */
typedef struct SubspaceErrors {
    double rms;    /* m: distance of a body's position from the recorded, RMS over bodies, frames, launches */
    double frames; /* until a body is further than 0.1 m from the recorded, median over the launches */
} SubspaceErrors;

typedef struct SubspaceScore {
    int components;
    SubspaceErrors floor;  /* of the recorded poses, projected and reconstructed: no predictor can avoid it */
    SubspaceErrors linear; /* of runs by the linear term alone */
    SubspaceErrors net;    /* of runs with the network */
} SubspaceScore;

typedef struct SubspaceTraining {
    int launches; /* recorded for training */
    int epochs;   /* for each network */
    int batches;  /* of an epoch, WINDOW_BATCH windows each */
    int hidden;   /* width of the hidden layers, a multiple of ROW_LANES */
    uint64_t seed;
    /* Called after each network with its errors on held-out launches; may be NULL. */
    void (*on_score)(void *context, const SubspaceScore *score, double loss);
    void *context;
} SubspaceTraining;

enum { SUBSPACE_HELD_OUT = 20 }; /* launches */

/* NULL with error set if the scene has no family of launches or too many bodies, a run fails, or memory is short. If
   progress requests a stop, networks are those so far, which at first add almost nothing to the linear terms;
   ERROR_INTERRUPTED while launches are recorded. Same bits for any number of threads. */
SubspaceNet *subspace_train(const Scene *scene, const SubspaceTraining *training, const Progress *progress,
                            Error *error);

/* Records launches[count] by the offline engine. Free them in any case. */
bool subspace_record(PoseRows *rows, const Scene *scene, const Launch *launches, int count, const Progress *progress,
                     Error *error);
void pose_rows_free(PoseRows *rows);

/* Runs the launches of `rows` from their first two states on. False with error set when memory is short. */
bool subspace_score(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows,
                    SubspaceScore *score, Error *error);
