/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subspace neural physics: the poses of all bodies of one scene as a few principal components, and networks that predict
   the components of the next step from their last two values. Source: Holden, Duong, Datta, Nowrouzezahrai, "Subspace
   Neural Physics: Fast Data-Driven Interactive Simulation" (SCA 2019), sections 4 and 5.

   A body that moves has four numbers in m: x, y, and sine and cosine of its angle, times its radius of gyration, so that
   a metre of each is as much motion. u is the vector of all of them less their values at rest, B the components (orthonormal rows, strongest first), so

       z = B u,   u = B^T z
       z' = clamp(a z + b z_before + N(z, z - z_before, launch), low, high)

   N: two tanh layers. Its launch numbers are what the poses do not tell of the bomb: start x (m), rotation (rad), spin
   (rad/s) and mass (kg). The predictors of a file are for different numbers of components of one basis.

   Rows are padded with 0 to a multiple of ROW_LANES numbers ("lanes"). Sums run in a fixed order
   (network/row_kernels.h), for the same bits on every machine. */
#pragma once
#include "common/error.h"
#include "network/row_kernels.h"

#include <stddef.h>

enum {
    SUBSPACE_VERSION = 1,
    SUBSPACE_PREDICTORS_MAX = 3,
    SUBSPACE_COMPONENTS_MAX = 128,
    SUBSPACE_BODIES_MAX = 256,
    SUBSPACE_HIDDEN_MAX = 256,
    SUBSPACE_FRAMES_MAX = 100000,
    SUBSPACE_POSE = 4,   /* numbers of a body */
    SUBSPACE_LAUNCH = 4, /* numbers of a launch */
    SUBSPACE_TEXT_SIZE = 512
};

#define SUBSPACE_KIND "subspace" /* of the file */

static inline int subspace_lanes(int count) { return (count + ROW_LANES - 1) / ROW_LANES * ROW_LANES; }

/* Dense layer: one row per input. */
typedef struct SubspaceLayer {
    int from, lanes;
    float *rows;   /* [from, lanes] */
    float *biases; /* [lanes] */
} SubspaceLayer;

typedef struct SubspacePredictor {
    int components;
    float *linear; /* [2, lanes] a, b */
    SubspaceLayer first, second, last;
} SubspacePredictor;

/* The sizes of a file; everything else follows from them. */
typedef struct SubspaceShape {
    int bodies;        /* that move, with the bomb, which is the last */
    int components;    /* of the basis: those of the largest predictor */
    int hidden;        /* width of the hidden layers, a multiple of ROW_LANES */
    int frames_before; /* steps before the bomb appears */
    int predictor_count;
    int predictors[SUBSPACE_PREDICTORS_MAX]; /* components of each, rising */
} SubspaceShape;

typedef struct SubspaceNet {
    SubspaceShape shape;
    float *rest;       /* [lanes of 4 bodies] */
    float *basis;      /* [components, lanes of 4 bodies] B */
    float *low, *high; /* [components] range in training */
    float *
        before; /* [frames_before, bodies - 1, 3] x, y, angle: the run before the bomb appears, the same for all launches */
    SubspacePredictor predictors[SUBSPACE_PREDICTORS_MAX];
    uint64_t physics;                 /* hash of the scene without its launch */
    char scene[SUBSPACE_TEXT_SIZE];   /* the scene of the training */
    char command[SUBSPACE_TEXT_SIZE]; /* the command that made it */
    float *block;                     /* all arrays */
} SubspaceNet;

/* ERROR_INPUT, naming `where`, for a shape out of bounds. */
bool subspace_shape_check(const SubspaceShape *shape, const char *where, Error *error);

/* All numbers 0. The shape must have passed the check. NULL with error set when memory is short. */
SubspaceNet *subspace_net_create(const SubspaceShape *shape, Error *error);

/* The sizes of all arrays, which stay NULL: for a look at a file before memory is taken. */
SubspaceNet subspace_net_sizes(const SubspaceShape *shape);
void subspace_net_destroy(SubspaceNet *net);

/* The predictor of at most so many components, or the smallest. */
const SubspacePredictor *subspace_net_choose(const SubspaceNet *net, int components);

bool subspace_net_write(const SubspaceNet *net, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version or kind, has inconsistent shapes, or holds a NaN or
   infinite number, or a range whose ends are exchanged. */
SubspaceNet *subspace_net_read(const char *path, Error *error);
