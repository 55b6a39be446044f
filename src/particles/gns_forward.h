/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The forward pass of the network of gns, for inference and, with a tape, for training. */
#pragma once
#include "particles/gns_graph.h"
#include "particles/gns_kernels.h"

/* What a perceptron leaves for its backward pass. Rows: nodes or edges. */
typedef struct GnsLayerTape {
    float *first, *second; /* [rows, width] hidden layers */
    float *normalised;     /* [rows, width] what the layer norm makes before gain and offset */
    float *inverse;        /* [rows] 1 / deviation */
} GnsLayerTape;

/* Zero-initialise; arrays grow and are reused. Inference keeps one set of latents and one tile of a perceptron; training
   keeps all, and so `tape` must not change between passes. */
typedef struct GnsPass {
    bool tape;
    const GnsKernels *kernels; /* NULL: the best */
    float *node[GNS_MAX_ROUNDS + 1],
        *edge[GNS_MAX_ROUNDS + 1]; /* [nodes, width], [edges, width]: before each round, and
                                                                   after the last; without a tape all the same */
    float *sum[GNS_MAX_ROUNDS];    /* [nodes, width] messages received; as above */
    float *outputs;                /* [nodes, GNS_OUTPUTS] accelerations in units of scales.acceleration */
    GnsLayerTape nodes, edges, node_rounds[GNS_MAX_ROUNDS], edge_rounds[GNS_MAX_ROUNDS], decoder;
    float *from_receiver, *from_sender; /* [nodes, width] */
    float *change;                      /* [tile, width] */
    float *numbers;                     /* all of the above */
    size_t capacity;
} GnsPass;

void gns_pass_free(GnsPass *pass);

/* Fills pass->outputs. False when memory is short. */
bool gns_forward(GnsPass *pass, const GnsLayout *layout, const float *parameters, const GnsGraph *graph);
