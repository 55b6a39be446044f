/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a predictor's runs end up from recorded ones, beside what no predictor of so many components can avoid. */
#pragma once
#include "subspace_training/pose_components.h"

#define SUBSPACE_APART 0.1 /* m */

typedef struct SubspaceErrors {
    double rms; /* m: distance of a body's position from the recorded, root mean square over bodies, frames, launches */
    double frames; /* until a body is further than SUBSPACE_APART from the recorded, median over the launches */
} SubspaceErrors;

typedef struct SubspaceScore {
    int components;
    SubspaceErrors floor;  /* of the recorded poses, projected and reconstructed */
    SubspaceErrors linear; /* of runs by the linear term alone */
    SubspaceErrors net;    /* of runs with the network */
} SubspaceScore;

/* Runs the launches of `rows` from their first two states on. False with error set when memory is short. */
bool subspace_score(const SubspaceNet *net, const SubspacePredictor *predictor, const PoseRows *rows,
                    SubspaceScore *score, Error *error);

/* How far other runs of the same launches end up from the recorded ones. */
bool subspace_distance(const PoseRows *rows, const PoseRows *others, SubspaceErrors *errors, Error *error);
