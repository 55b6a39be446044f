/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Boxes as particles, the graph of particles, and the forward pass of the network of gns over it.

       gns_graph_build(&graph, &particles, ground, ground_count, &net.scales);
       gns_forward(&pass, &net.layout, net.parameters, &graph);   pass.outputs: accelerations */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "nets/kernels.h"
#include "nets/kinds.h"

#include <stdbool.h>
#include <stddef.h>

/* A box as particles: its corners, the middles of its edges and its centre; and the rigid box that fits nine particles
   best. Rigid fit of points: Müller, Heidelberger, Teschner, Gross, "Meshless Deformations Based on Shape Matching"
   (2005); in the plane the polar decomposition has a closed form. */

enum { BOX_PARTICLES = 9 };

/* m, in the frame of the box: row by row from the lower left corner. */
Vec2 box_particle(int k, Vec2 size);

/* Where the particles [BOX_PARTICLES] of a box are. */
void box_particles_place(Vec2 *particles, Vec2 size, const BodyPose *pose);

/* The pose whose particles have the least mean square distance to these; `near` gives the whole turns of its angle. The
   same bits on every machine. */
BodyPose box_particles_fit(const Vec2 *particles, Vec2 size, const BodyPose *near);

/* The angle of (cosine, sine), -pi to pi, without the maths library; the two need not have length 1. 0 for (0, 0). */
double plane_angle(double cosine, double sine);

/* What the network of gns sees: particles as nodes, and an edge each way between two that are nearer than the radius.
   Source: nets/kinds.h.

   Inputs of a node: the particle's last GNS_HISTORY velocities, oldest first, over the unit of velocity (10 numbers); 1
   for the bomb, else 0; the way to the nearest static box: its distance over the radius, at most 1, and its direction
   times 1 less that (3 numbers). Those of an edge: from the receiver to the sender, over the radius, with the length of
   it (3 numbers); the sender's share of the mass of both; 1 within one box, else 0. The last two are not the paper's:
   its particles have no masses, and its one rigid body is a material of its own. */

enum {
    GNS_NEIGHBOURS = 40 /* of a particle at most, so that a heap of boxes in one place has a bounded number of edges */
};

/* A box that moves. */
typedef struct GnsBody {
    Vec2 size;  /* m */
    float mass; /* kg */
    bool bomb;
} GnsBody;

/* Body after body, BOX_PARTICLES of each. */
typedef struct GnsParticles {
    int bodies;
    GnsBody *body;                 /* [bodies] */
    Vec2 *position;                /* [particles] m */
    Vec2 (*velocity)[GNS_HISTORY]; /* [particles] m/s, oldest first; the newest led to the position */
} GnsParticles;

static inline int gns_particle_count(const GnsParticles *particles) { return BOX_PARTICLES * particles->bodies; }

/* Zero-initialise; arrays grow and are reused. */
typedef struct GnsGraph {
    int nodes, edges;
    float *node_inputs;     /* [nodes, GNS_NODE_INPUTS] */
    float *edge_inputs;     /* [edges, GNS_EDGE_INPUTS] */
    int *receiver, *sender; /* [edges] rising by receiver */
    bool beyond;       /* a particle was faster than any in training, or has too many neighbours: inputs were clamped */
    int *first, *next; /* the grid: heads of its lists of particles, and the particle after each; -1: no more */
    int64_t (*cell)[2]; /* [nodes] */
    ArrayBlock arrays;
} GnsGraph;

void gns_graph_free(GnsGraph *graph);

/* ground[count]: the static boxes. False when memory is short. */
bool gns_graph_build(GnsGraph *graph, const GnsParticles *particles, const Box *ground, int count,
                     const GnsScales *scales);

/* The forward pass of the network of gns, for inference and, with a tape, for training. */

/* What a perceptron leaves for its backward pass. Rows: nodes or edges. */
typedef struct GnsLayerTape {
    float *first, *second; /* [rows, width] hidden layers */
    float *normalised;     /* [rows, width] what the layer norm makes before gain and offset */
    float *inverse;        /* [rows] 1 / deviation */
} GnsLayerTape;

/* Zero-initialise; arrays grow and are reused. Inference keeps one set of latents and one tile of a perceptron;
   training keeps all, and so `tape` must not change between passes. */
typedef struct GnsPass {
    bool tape;
    const GnsKernels *kernels; /* NULL: the best */
    /* [nodes, width], [edges, width]: before each round, and after the last; without a tape all the same. */
    float *node[GNS_MAX_ROUNDS + 1], *edge[GNS_MAX_ROUNDS + 1];
    float *sum[GNS_MAX_ROUNDS]; /* [nodes, width] messages received; as above */
    float *outputs;             /* [nodes, GNS_OUTPUTS] accelerations in units of scales.acceleration */
    GnsLayerTape nodes, edges, node_rounds[GNS_MAX_ROUNDS], edge_rounds[GNS_MAX_ROUNDS], decoder;
    float *from_receiver, *from_sender; /* [nodes, width] */
    float *change;                      /* [tile, width] */
    float *numbers;                     /* all of the above */
    size_t capacity;
} GnsPass;

void gns_pass_free(GnsPass *pass);

/* Fills pass->outputs. False when memory is short. */
bool gns_forward(GnsPass *pass, const GnsLayout *layout, const float *parameters, const GnsGraph *graph);
