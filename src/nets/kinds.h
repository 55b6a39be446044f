/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of networks beyond layers: gns, scene networks with slots, subspace; their shapes and files. */
#pragma once
#include "base/base.h"
#include "nets/kernels.h"

/* The network of gns (methods/gns.c): a graph network over particles. Source: Sanchez-Gonzalez, Godwin, Pfaff, Ying,
   Leskovec, Battaglia, "Learning to Simulate Complex Physics with Graph Networks" (2020), section 3 and appendix.

       encoder    v_i = f_v(node inputs),  e_ij = f_e(edge inputs)
       M rounds   d_ij = g_m(e_ij, v_i, v_j),  d_i = h_m(v_i, sum_j d_ij),  e += d, v += d
       decoder    a_i = f_a(v_i)

   Each function is a perceptron with two hidden layers (ReLU); all but the decoder end in a layer norm. Each round has
   its own weights. float32; sums run in one order, so the bits are the same on every machine. */

enum {
    GNS_VERSION = 2,
    GNS_HISTORY = 5,      /* past velocities of a particle (paper) */
    GNS_NODE_INPUTS = 14, /* methods/gns_graph.c */
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

typedef struct GnsNet {
    GnsLayout layout;
    GnsScales scales;
    float gravity[2];  /* m/s^2: of the scenes that it learned, where what rests is held against it */
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

/* Subspace neural physics: the poses of all bodies of one scene as a few principal components, and networks that
   predict the components of the next step from their last two values. Source: Holden, Duong, Datta, Nowrouzezahrai,
   "Subspace Neural Physics: Fast Data-Driven Interactive Simulation" (SCA 2019), sections 4 and 5.

   A body that moves has four numbers in m: x, y, and sine and cosine of its angle, times its radius of gyration, so
   that a metre of each is as much motion. u is the vector of all of them less their values at rest, B the components
   (orthonormal rows, strongest first), so

       z = B u,   u = B^T z
       z' = clamp(a z + b z_before + N(z, z - z_before, launch), low, high)

   N: two tanh layers. Its launch numbers are what the poses do not tell of the bomb: start x (m), rotation (rad), spin
   (rad/s) and mass (kg). The predictors of a file are for different numbers of components of one basis.

   Rows are padded with 0 to a multiple of ROW_LANES numbers ("lanes"). Sums run in a fixed order
   (nets/kernels.h), for the same bits on every machine. */

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
    int hidden;        /* width of the hidden layers, a multiple of ROW_LANES */
    int frames_before; /* steps before the bomb appears */
    int components;    /* of the basis: those of the largest predictor */
    int predictor_count;
    int predictors[SUBSPACE_PREDICTORS_MAX]; /* components of each, rising */
} SubspaceShape;

typedef struct SubspaceNet {
    SubspaceShape shape;
    float *rest;       /* [lanes of 4 bodies] */
    float *basis;      /* [components, lanes of 4 bodies] B */
    float *low, *high; /* [components] range in training */
    /* [frames_before, bodies - 1, 3] x, y, angle: the run before the bomb appears, the same for all launches */
    float *before;
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
void subspace_net_destroy(SubspaceNet *net);

/* The predictor of at most so many components, or the smallest. */
const SubspacePredictor *subspace_net_choose(const SubspaceNet *net, int components);

bool subspace_net_write(const SubspaceNet *net, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version or kind, has inconsistent shapes, or holds a NaN
   or infinite number, or a range whose ends are exchanged. */
SubspaceNet *subspace_net_read(const char *path, Error *error);

/* The angle of a sine and a cosine in a fixed sequence of operations, for the same bits with any maths library. */

/* Below this length a sine and a cosine give no direction. */
#define TURN_SHORTEST 1e-3f

/* atan(q) for 0 <= q <= 1, within 2e-6 rad. Abramowitz and Stegun, "Handbook of Mathematical Functions" (1964), 4.4.49,
   with coefficients to q^17. */
static inline float turn_arc(float q) {
    const float q2 = q * q;
    const float high =
        0.1065626393f + q2 * (-0.0752896400f + q2 * (0.0429096138f + q2 * (-0.0161657367f + q2 * 0.0028662257f)));
    return q * (1.0f + q2 * (-0.3333314528f + q2 * (0.1999355085f + q2 * (-0.1420889944f + q2 * high))));
}

/* The angle in rad, as near to `before` as whole turns allow; `before` itself if the two are too short to tell. */
static inline float turn_angle(float sine, float cosine, float before) {
    const float s = fabsf(sine), c = fabsf(cosine), most = s > c ? s : c, least = s > c ? c : s;
    if (!(most >= TURN_SHORTEST)) return before;
    const float eighth = turn_arc(least / most);
    const float quarter = s > c ? 1.57079633f - eighth : eighth;
    const float half = cosine < 0 ? 3.14159265f - quarter : quarter;
    const float angle = sine < 0 ? -half : half;
    /* Adding 1.5 * 2^23 rounds to an integer, as in nets/activation.h. */
    const float shift = 0x1.8p23f, turns = ((before - angle) * 0.159154943f + shift) - shift;
    return angle + 6.28318531f * turns;
}

/* A state in the subspace, and its step. */

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

/* Component k of z = B u, of a state of 4 numbers per body. */
float subspace_component(const SubspaceNet *net, const float *numbers, int k);

/* Starts from two states of 4 numbers per body, one step apart. */
void subspace_start(Subspace *subspace, const float *last, const float *now);

/* One step: z_before = z, z = z'. A component that is not finite keeps its value. */
SubspaceReport subspace_step(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]);

/* Fills `numbers` from z. */
void subspace_reconstruct(Subspace *subspace);

/* A network for the impacts of one scene: from the state of all bodies it predicts, for all contacts at once, their
   impulses less the warm start. A slot is a possible contact of the scene: two bodies and a feature that occurred in
   training. In each step some of the slots are present.

       x  = bomb's state; projections (learning/principal.h) of the other bodies' state, of which slots
            are present, and of their warm-start impulses
       h1 = tanh(W1 x + b1),   h2 = tanh(W2 h1 + b2)
       (dPn, dPt) of slot s = scale[s] (W3 h2 + b3)[s]

   Only the rows of present slots are read. Inference uses rows rounded to bytes (PackedRows); training and files use
   the float rows. Sums run in a fixed order (RowKernels), for the same bits on every machine. */

enum {
    SCENE_NET_NETWORK_VERSION = 2,
    SCENE_NET_BODIES_MAX = 256,
    SLOTS_MAX = 20000,
    SCENE_NET_WIDTH_MAX = 1024,
    SLOT_BODY_NUMBERS = 6, /* of a body: x, y (m), angle (rad), velocity x, y (m/s), spin (rad/s) */
    SCENE_NET_SWEEPS_MAX = 64,
    SCENE_NET_TEXT_SIZE = 512
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
typedef struct SceneNetLayer {
    int from, to;
    float *rows;   /* [from, to] */
    float *biases; /* [to] */
    PackedRows packed;
} SceneNetLayer;

typedef struct SceneNet {
    int body_count, bomb; /* bodies of the scene, with the bomb; the bomb's index */
    int slot_count;
    Slot *slots;                  /* [slot_count] rising by a, b, feature */
    Projection bomb_state, state; /* of SLOT_BODY_NUMBERS, and of as many for each body but the bomb */
    Projection present, warm;     /* of slot_count, and of (normal, tangent) of each */
    SceneNetLayer first, second;  /* from the inputs to the hidden widths */
    float *rows, *biases;         /* [2 slot_count, second.to], [2 slot_count]: the last layer */
    PackedRows packed;            /* its rows */
    float *scale;                 /* [slot_count] N s */
    float *cap;                   /* [slot_count] N s: larger warm-start impulses are clamped to it */
    float gate;        /* m/s: the network is used if the warm start's residual (RMS over the contacts) exceeds this */
    float *low, *high; /* [inputs] range in training */
    float bomb_inv_mass;                 /* 1/kg: in training */
    int sweeps;                          /* number of sweeps that the factors were fitted for; 0: none */
    float factors[SCENE_NET_SWEEPS_MAX]; /* of momentum, after the network */
    char scene[SCENE_NET_TEXT_SIZE];     /* the scene of the training */
    char command[SCENE_NET_TEXT_SIZE];   /* the command that made it */
    int32_t *pair_slots; /* [body_count * body_count + 1] first slot of pair (a, b) or of a later pair */
    float *parameters;   /* the trained parameters, one after the other: layers, rows, biases */
    size_t parameter_count;
    const RowKernels *kernels; /* for inference; the fastest */
    void *block;               /* all arrays */
} SceneNet;

/* Sizes of its inputs. */
static inline int scene_net_inputs(const SceneNet *network) { return network->first.from; }
static inline int scene_net_hidden(const SceneNet *network) { return network->second.to; }

typedef struct SceneNetShape {
    int body_count, bomb, slot_count;
    int state, present, warm; /* components of each; those of the bomb are ROW_LANES */
    int hidden;               /* width of both hidden layers */
} SceneNetShape;

/* All numbers 0, the slots copied. ERROR_INPUT as from scene_net_shape_check(). */
SceneNet *scene_net_create(const SceneNetShape *shape, const Slot *slots, Error *error);
void scene_net_destroy(SceneNet *network);

/* The slot of a contact, or -1. */
int scene_net_find(const SceneNet *network, int a, int b, uint32_t feature);

/* Rounds the current rows: of all matrices, or only of the three layers. A network read from a file is already
   rounded. */
void scene_net_pack(SceneNet *network);
void scene_net_pack_layers(SceneNet *network);

/* The inputs in one step. */
typedef struct SceneNetView {
    const float *bomb;       /* [SLOT_BODY_NUMBERS] */
    const float *state;      /* [SLOT_BODY_NUMBERS * (body_count - 1)] */
    int slot_count;          /* present */
    const int32_t *slots;    /* [slot_count] */
    const int32_t *impulses; /* [2 slot_count]: 2 slot, 2 slot + 1 */
    const float *ones;       /* [slot_count] 1 each */
    const float *warm;       /* [2 slot_count] N s */
} SceneNetView;

/* inputs[scene_net_inputs] */
void scene_net_look(const SceneNet *network, const SceneNetView *view, float *inputs);

/* first[first.to], second[second.to]: the hidden layers; outputs[2 slot_count of the view]: (dPn, dPt) in N s. */
void scene_net_predict(const SceneNet *network, const float *inputs, const SceneNetView *view, float *first,
                       float *second, float *outputs);

bool scene_net_write(const SceneNet *network, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version or kind, has inconsistent shapes, or holds a NaN
   or infinite number, a negative scale, cap, gate or mass, or momentum factors that are not from 0 to 2. */
SceneNet *scene_net_read(const char *path, Error *error);
