/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state in the subspace, and its step (subspace_net.h has the equations). */
#pragma once
#include "subspace/subspace_net.h"

typedef struct Subspace {
    const SubspaceNet *net; /* outlives it */
    const SubspacePredictor *predictor;
    const RowKernels *kernels;      /* the fastest */
    bool corrects;                  /* false: the linear term alone */
    float *now, *last, *next;       /* [lanes of the components] z, z_before, z' */
    float *inputs, *first, *second; /* of the network, and its hidden layers */
    float *numbers;                 /* [lanes of 4 bodies] rest + B^T z, after subspace_reconstruct */
} Subspace;

/* What a step clamped or discarded, in components. */
typedef struct SubspaceReport {
    int beyond, not_finite;
} SubspaceReport;

/* All components 0. Free it in any case. */
bool subspace_make(Subspace *subspace, const SubspaceNet *net, const SubspacePredictor *predictor, bool corrects,
                   Error *error);
void subspace_free(Subspace *subspace);

/* Starts from two states of 4 numbers per body, one step apart. */
void subspace_start(Subspace *subspace, const float *last, const float *now);

/* One step: z_before = z, z = z'. A component that is not finite keeps its value. */
SubspaceReport subspace_step(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]);

/* Fills `numbers` from z. */
void subspace_reconstruct(Subspace *subspace);
