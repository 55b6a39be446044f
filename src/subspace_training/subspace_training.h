/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains the networks of `subspace` for a scene: records training launches by an offline engine, finds their principal
   components, fits the linear terms, then trains a network for each number of components. Source: Holden et al. 2019
   (subspace/subspace_net.h). */
#pragma once
#include "subspace_training/subspace_score.h"
#include "subspace_training/window_fit.h"

typedef struct SubspaceTraining {
    int launches; /* recorded for training */
    int epochs;   /* for each network */
    int batches;  /* of an epoch, WINDOW_BATCH windows each */
    int hidden;   /* width of the hidden layers, a multiple of ROW_LANES */
    uint64_t seed;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists; the caller removes it once it has
                               stored the networks */
    /* Called after each network with its errors on held-out launches; may be NULL. */
    void (*on_score)(void *context, const SubspaceScore *score, double loss);
    void *context;
} SubspaceTraining;

enum { SUBSPACE_HELD_OUT = 20 }; /* launches */

/* The method that the launches are recorded with. */
#define SUBSPACE_OFFLINE "interior:near=0.001"

/* Records launches[count] by a method and turns them into rows. Free them in any case. */
bool subspace_record(PoseRows *rows, const Scene *scene, const char *method, const Launch *launches, int count,
                     const Progress *progress, Error *error);

/* NULL with error set if the scene has no family of launches or too many bodies, a run fails, the state cannot be written
   or read, or memory is short; ERROR_INTERRUPTED if progress requests a stop: the state stays. Same bits for any number of
   threads, and however often it was interrupted. */
SubspaceNet *subspace_train(const Scene *scene, const SubspaceTraining *training, const Progress *progress,
                            Error *error);
