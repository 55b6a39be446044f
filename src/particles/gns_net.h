/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of gns (simulate/gns.c): a graph network over particles. Source: Sanchez-Gonzalez, Godwin, Pfaff, Ying,
   Leskovec, Battaglia, "Learning to Simulate Complex Physics with Graph Networks" (2020), section 3 and appendix.

       encoder    v_i = f_v(node inputs),  e_ij = f_e(edge inputs)
       M rounds   d_ij = g_m(e_ij, v_i, v_j),  d_i = h_m(v_i, sum_j d_ij),  e += d, v += d
       decoder    a_i = f_a(v_i)

   Each function is a perceptron with two hidden layers (ReLU); all but the decoder end in a layer norm. Each round has its
   own weights. float32; sums run in one order, so the bits are the same on every machine. */
#pragma once
#include "common/error.h"

#include <stdint.h>

enum {
    GNS_VERSION = 1,
    GNS_HISTORY = 5,      /* past velocities of a particle (paper) */
    GNS_NODE_INPUTS = 14, /* gns_graph.h */
    GNS_EDGE_INPUTS = 5,
    GNS_OUTPUTS = 2,
    GNS_WIDTH_STEP = 16,
    GNS_MAX_WIDTH = 128,
    GNS_MAX_ROUNDS = 10, /* the largest of the paper */
    GNS_MAX_MLPS = 3 + 2 * GNS_MAX_ROUNDS,
    GNS_COMMAND_SIZE = 1024
};

/* Units of inputs and outputs, and what the training data had at most. */
typedef struct GnsScales {
    float radius;       /* m: particles nearer than this exchange messages */
    float velocity;     /* m/s: inputs are multiples of it */
    float acceleration; /* m/s^2: outputs are multiples of it */
    float fastest;      /* m/s: of a particle in the training data */
    float strongest;    /* m/s^2: acceleration, other than gravity's, of a particle there */
} GnsScales;

/* A perceptron inputs -> width -> width -> outputs. Offsets into the parameters: weights are [inputs, outputs] of a
   layer. */
typedef struct GnsMlp {
    int inputs, width, outputs;
    int weights[3], biases[3];
    int gain, offset; /* of the layer norm; -1: it has no such layer */
} GnsMlp;

/* In the order of the parameters. */
typedef struct GnsLayout {
    int width, rounds, parameters;
    GnsMlp nodes, edges;                /* encoder */
    GnsMlp edge_rounds[GNS_MAX_ROUNDS]; /* inputs: edge, receiver, sender */
    GnsMlp node_rounds[GNS_MAX_ROUNDS]; /* inputs: node, sum of messages */
    GnsMlp decoder;
} GnsLayout;

/* width: a multiple of GNS_WIDTH_STEP up to GNS_MAX_WIDTH; rounds: 1 to GNS_MAX_ROUNDS. */
GnsLayout gns_layout(int width, int rounds);

typedef struct GnsNet {
    GnsLayout layout;
    GnsScales scales;
    float *parameters; /* [layout.parameters] */
    char command[GNS_COMMAND_SIZE];
} GnsNet;

/* Parameters are 0. False when memory is short. Free it in any case. */
bool gns_net_create(GnsNet *net, int width, int rounds, Error *error);
void gns_net_free(GnsNet *net);

bool gns_net_write(const GnsNet *net, const char *path, Error *error);

/* ERROR_INPUT, naming the file: it is no such network, of another version, too wide or too deep, or a number is NaN or
   infinite. Free the net in any case. */
bool gns_net_read(GnsNet *net, const char *path, Error *error);
