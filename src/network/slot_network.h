/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network for the impacts of one scene: from the state of all bodies it predicts, for all contacts at once, their
   impulses less the warm start. A slot is a possible contact of the scene: two bodies and a feature that occurred in
   training. In each step some of the slots are present.

       x  = bomb's state; projections (impact_training/principal.h) of the other bodies' state, of which slots are
            present, and of their warm-start impulses
       h1 = tanh(W1 x + b1),   h2 = tanh(W2 h1 + b2)
       (dPn, dPt) of slot s = scale[s] (W3 h2 + b3)[s]

   Only the rows of present slots are read. Inference uses rows rounded to bytes (packed_rows.h); training and files use
   the float rows. Sums run in a fixed order (row_kernels.h), for the same bits on every machine. */
#pragma once
#include "common/error.h"
#include "network/row_kernels.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    SLOT_NETWORK_VERSION = 2,
    SLOT_BODIES_MAX = 256,
    SLOTS_MAX = 20000,
    SLOT_WIDTH_MAX = 1024,
    SLOT_BODY_NUMBERS = 6, /* of a body: x, y (m), angle (rad), velocity x, y (m/s), spin (rad/s) */
    SLOT_SWEEPS_MAX = 64,
    SLOT_TEXT_SIZE = 512
};

typedef struct Slot {
    int32_t a, b;
    uint32_t feature;
} Slot;

/* components[to] = sum of numbers[i] * rows[i] - centre; `to` is a multiple of ROW_LANES. */
typedef struct Projection {
    int from, to;
    float *rows;   /* [from, to] */
    float *centre; /* [to] */
    PackedRows packed;
} Projection;

/* Dense layer, one row per input. */
typedef struct SlotLayer {
    int from, to;
    float *rows;   /* [from, to] */
    float *biases; /* [to] */
    PackedRows packed;
} SlotLayer;

typedef struct SlotNetwork {
    int body_count, bomb; /* bodies of the scene, with the bomb; the bomb's index */
    int slot_count;
    Slot *slots;                  /* [slot_count] rising by a, b, feature */
    Projection bomb_state, state; /* of SLOT_BODY_NUMBERS, and of as many for each body but the bomb */
    Projection present, warm;     /* of slot_count, and of (normal, tangent) of each */
    SlotLayer first, second;      /* from the inputs to the hidden widths */
    float *rows, *biases;         /* [2 slot_count, second.to], [2 slot_count]: the last layer */
    PackedRows packed;            /* its rows */
    float *scale;                 /* [slot_count] N s */
    float *cap;                   /* [slot_count] N s: larger warm-start impulses are clamped to it */
    float gate;        /* m/s: the network is used if the warm start's residual (RMS over the contacts) exceeds this */
    float *low, *high; /* [inputs] range in training */
    float bomb_inv_mass;            /* 1/kg: in training */
    int sweeps;                     /* number of sweeps that the factors were fitted for; 0: none */
    float factors[SLOT_SWEEPS_MAX]; /* of momentum, after the network */
    char scene[SLOT_TEXT_SIZE];     /* the scene of the training */
    char command[SLOT_TEXT_SIZE];   /* the command that made it */
    int32_t *pair_slots;            /* [body_count * body_count + 1] first slot of pair (a, b) or of a later pair */
    float *parameters;              /* the trained parameters: layers, rows, biases; in one block */
    size_t parameter_count;
    const RowKernels *kernels; /* for inference; the fastest */
} SlotNetwork;

/* Sizes of its inputs. */
static inline int slot_network_inputs(const SlotNetwork *network) { return network->first.from; }
static inline int slot_network_hidden(const SlotNetwork *network) { return network->second.to; }

typedef struct SlotShape {
    int body_count, bomb, slot_count;
    int state, present, warm; /* components of each; those of the bomb are ROW_LANES */
    int hidden;               /* width of both hidden layers */
} SlotShape;

/* ERROR_INPUT, naming `where`, if the shape is out of bounds or the slots are not sorted. */
bool slot_shape_check(const SlotShape *shape, const Slot *slots, const char *where, Error *error);

/* All numbers 0, the slots copied. ERROR_INPUT as from slot_shape_check(). */
SlotNetwork *slot_network_create(const SlotShape *shape, const Slot *slots, Error *error);
void slot_network_destroy(SlotNetwork *network);

/* The slot of a contact, or -1. */
int slot_network_find(const SlotNetwork *network, int a, int b, uint32_t feature);

/* Rounds the current rows: of all matrices, or only of the three layers. A network read from a file is already
   rounded. */
void slot_network_pack(SlotNetwork *network);
void slot_network_pack_layers(SlotNetwork *network);

/* The inputs in one step. */
typedef struct SlotView {
    const float *bomb;       /* [SLOT_BODY_NUMBERS] */
    const float *state;      /* [SLOT_BODY_NUMBERS * (body_count - 1)] */
    int slot_count;          /* present */
    const int32_t *slots;    /* [slot_count] */
    const int32_t *impulses; /* [2 slot_count]: 2 slot, 2 slot + 1 */
    const float *ones;       /* [slot_count] 1 each */
    const float *warm;       /* [2 slot_count] N s */
} SlotView;

/* inputs[slot_network_inputs] */
void slot_network_look(const SlotNetwork *network, const SlotView *view, float *inputs);

/* first[first.to], second[second.to]: the hidden layers; outputs[2 slot_count of the view]: (dPn, dPt) in N s. */
void slot_network_predict(const SlotNetwork *network, const float *inputs, const SlotView *view, float *first,
                          float *second, float *outputs);

bool slot_network_write(const SlotNetwork *network, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version or kind, has inconsistent shapes, or holds a NaN
   or infinite number, a negative scale, cap, gate or mass, or momentum factors that are not from 0 to 2. */
SlotNetwork *slot_network_read(const char *path, Error *error);
