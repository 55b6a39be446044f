/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the network of gns sees: particles as nodes, and an edge each way between two that are nearer than the radius.
   Source: gns_net.h.

   Inputs of a node: the particle's last GNS_HISTORY velocities, oldest first, over the unit of velocity (10 numbers); 1 for
   the bomb, else 0; the way to the nearest static box: its distance over the radius, at most 1, and its direction times 1
   less that (3 numbers). Those of an edge: from the receiver to the sender, over the radius, with the length of it (3
   numbers); the sender's share of the mass of both; 1 within one box, else 0. The last two are not the paper's: its
   particles have no masses, and its one rigid body is a material of its own. */
#pragma once
#include "collision/manifold.h"
#include "particles/box_particles.h"
#include "particles/gns_net.h"

#include <stdbool.h>
#include <stddef.h>

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
    size_t node_capacity, edge_capacity, edge_input_capacity, receiver_capacity, sender_capacity, first_capacity,
        next_capacity, cell_capacity;
} GnsGraph;

void gns_graph_free(GnsGraph *graph);

/* ground[count]: the static boxes. False when memory is short. */
bool gns_graph_build(GnsGraph *graph, const GnsParticles *particles, const Box *ground, int count,
                     const GnsScales *scales);
