/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What steppers share: particles and graphs of gns, free flight, contacts of the last step, poses of subspace. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

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

/* m: the root of that mean square. */
float box_particles_distance(const Vec2 *particles, Vec2 size, const BodyPose *pose);

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

/* The momentum_error of methods without impulses: where no contact is, only gravity may change a momentum. */

/* N s: the sum over bodies without a contact of the momentum that they gained besides gravity's. touched[body_count] is
   work space. */
float free_flight_momentum(const ContactProblem *problem, const ContactSolution *solution, bool *touched);

/* What the stepper gns (gns.c) knows besides the world. */

/* m: after a step, how far the particles of stepping_gns's state are from the best-fitting rigid boxes: the root of the
   mean square over the particles of a box, mean over boxes; 0 with rigid=on, but for rounding, and without boxes. */
float gns_shape_distance(const void *state);

/* Which contacts and bodies of a step are those of the stepper's last step, for steppers that carry more from step to
   step than the impulses that the world keeps. A body is known only if its state is, bit for bit, the one that the last
   step ended with: in another world, a copy of an earlier state or a new launch it is not. */

typedef struct KeptContact {
    int a, b;
    uint32_t feature;
} KeptContact;

/* Zero-initialise; free with step_memory_free. */
typedef struct StepMemory {
    int body_count, contact_count; /* of the last step */
    Body *bodies;                  /* [body_count] after it */
    KeptContact *contacts;         /* [contact_count] */
    bool *known;                   /* [bodies of this step] */
    int *before;                   /* [contacts of this step] index of the same point in the last step, or -1 */
    size_t body_capacity, contact_capacity, known_capacity, before_capacity;
} StepMemory;

void step_memory_free(StepMemory *memory);

/* Fills `known` and `before` for a step that has begun; nothing is known in the first step of a run, and no contact
   without warm starting. False when memory is short. */
bool step_memory_match(StepMemory *memory, const World *world, const Step *step);

/* Call it after the step has ended; it does not fail, as step_memory_match has reserved the arrays. */
void step_memory_keep(StepMemory *memory, const World *world);

/* What the method `subspace` and its training must see alike. */

/* Hash of what a network is trained for: bodies, bomb, gravity and time step, but not the launch nor how contacts are
   solved, because no contact is. */
uint64_t subspace_physics(const Scene *scene);

/* The launch as a predictor sees it. */
void subspace_launch(const Scene *launched, float launch[SUBSPACE_LAUNCH]);

/* The four numbers of a body's pose. */
void subspace_pose_numbers(Vec2 size, Vec2 position, float angle, float numbers[SUBSPACE_POSE]);
