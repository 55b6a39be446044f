/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of gns: examples of recorded launches, the gradient, the fit. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

/* Single steps of recorded launches, with noise on the inputs, for the network of gns. Source: section 4.3 and appendix
   of nets/kinds.h's.

   Noise: a random walk of each particle's velocities, with the standard deviation `noise` in the newest; positions move
   by its sum. The target is the acceleration from the noisy velocity to the true next one, less a tenth of what would
   undo the noise of the position in one step: so overlaps and gaps close again. The paper corrects the velocity only;
   the tenth is that of Pfaff, Fortunato, Sanchez-Gonzalez, Battaglia, "Learning Mesh-Based Simulation with Graph
   Networks" (2021), for second-order dynamics. In half of the examples each box is also displaced as a whole, so that
   there are overlaps as deep as those of runs; the paper's particles are disturbed one by one only. */

enum {
    GNS_MAX_SCENES = 8,
    GNS_CROP = 12 /* boxes of an example at most: the nearest to one of them */
};

/* A scene and launches of it. */
typedef struct GnsRuns {
    Scene *scene;
    LaunchRuns runs;
    int *touch;  /* [launches] the first frame after which the bomb does not fly freely */
    Box *ground; /* [ground_count] */
    int ground_count;
    int *moving; /* [moving_count] bodies of the scene that move, without the bomb */
    int moving_count;
} GnsRuns;

typedef struct GnsExamples {
    int count; /* of scenes */
    GnsRuns scenes[GNS_MAX_SCENES];
    float noise; /* m/s */
    uint64_t seed;
} GnsExamples;

/* Records `launches` launches of a scene by a method; the examples own the scene. Free them in any case. */
bool gns_examples_add(GnsExamples *examples, Scene *scene, const Method *method, int launches, const Progress *progress,
                      Error *error);
void gns_examples_free(GnsExamples *examples);

/* Zero-initialise. */
typedef struct GnsExample {
    GnsParticles particles;
    GnsGraph graph;
    float *targets; /* [particles, GNS_OUTPUTS] m/s^2, without gravity */
    float *counts;  /* [bodies] 1: it counts; 0: boxes that touch it may lie outside of the example */
    const GnsRuns *from;
    size_t body_capacity, position_capacity, velocity_capacity, target_capacity, count_capacity;
} GnsExample;

void gns_example_free(GnsExample *example);

/* Example `number` of a seed: the same on every machine. Does not build the graph. False when memory is short. */
bool gns_example_make(GnsExample *example, const GnsExamples *examples, uint64_t number);

/* All boxes of a frame, without noise and targets: for times of a step. */
bool gns_example_frame(GnsExample *example, const GnsRuns *runs, int launch, int frame);

/* Trains the network of gns on single steps of recorded launches by Adam with a falling rate. Source: see
   nets/kinds.h. */

#define GNS_PAPER_STEPS 20e6 /* gradient steps of the paper, appendix B */
#define GNS_PAPER_BATCH 2    /* examples in each */

/* The method whose runs are recorded. */
extern const char gns_teacher[];

typedef struct GnsScore {
    int steps; /* so far */
    double loss,
        held_out; /* mean squared errors in units of scales.acceleration: of the last epoch's examples, with their
                              noise; of held-out examples */
} GnsScore;

typedef struct GnsTraining {
    int width, rounds;
    int steps;           /* gradient steps */
    int batch;           /* examples in each */
    int launches;        /* recorded of each scene */
    float radius, noise; /* m, m/s */
    double rate;         /* of the first step; it falls to 0 in equal steps */
    uint64_t seed;
    Scene *const *scenes; /* [scene_count] the examples take them */
    int scene_count;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists. The caller removes it once it has
                               stored the network */
    void (*on_score)(void *context, const GnsScore *score); /* after each tenth of the steps; may be NULL */
    void *context;
    double seconds_a_step,
        seconds_a_pass; /* out: mean wall time of a gradient step in this process, 0 without one; time of
                                              a forward pass over all boxes of the last scene */
    int pass_boxes;     /* out: of that scene, with the bomb */
} GnsTraining;

/* Makes the net, which the caller frees. False with error set if the state cannot be written or read, memory is short
   or a run fails. ERROR_INTERRUPTED if progress requests a stop: the state stays. The same bits for any number of
   threads, and however often it was interrupted. */
bool gns_training_run(GnsTraining *training, GnsNet *net, const Progress *progress, Error *error);

/* The time of a forward pass with its neighbour search, on one thread, over all boxes of the recorded scene once the
   bomb is there: their number in *boxes. The least of a few. */
bool gns_training_time_pass(const GnsNet *net, const GnsRuns *runs, double *seconds, int *boxes, Error *error);

/* The backward pass of the network of gns: reverse mode, by hand, the steps of methods/gns_graph.c in reverse order.
   float32 as the forward pass, sums in one order. Source: Rumelhart, Hinton, Williams, "Learning representations by
   back-propagating errors" (1986). */

/* Work space; zero-initialise. */
typedef struct GnsBackward {
    float *of_node, *of_edge, *of_sum, *of_receiver, *of_sender; /* d loss / d ..., [nodes or edges, width] */
    float *slopes, *second, *first;                              /* of a perceptron's layers, [rows, width] */
    float *numbers;
    size_t capacity;
} GnsBackward;

void gns_backward_free(GnsBackward *back);

/* Every weight matrix of the parameters that a backward pass uses, transposed, at its place; that of a round's first
   layer part by part. */
void gns_transpose(const GnsLayout *layout, const float *parameters, float *transposed);

/* After gns_forward with a tape: adds d loss / d parameters to gradient, from output_slopes[nodes, GNS_OUTPUTS] = d
   loss / d outputs. False when memory is short. */
bool gns_backward(GnsBackward *back, const GnsPass *pass, const GnsLayout *layout, const float *parameters,
                  const float *transposed, const GnsGraph *graph, const float *output_slopes, float *gradient);

/* Losses and gradients of batches of examples, on all threads. */

/* Of one thread. */
typedef struct GnsWorker {
    GnsExample example;
    GnsPass pass;
    GnsBackward back;
    float *slopes; /* [particles, GNS_OUTPUTS] of the loss */
    size_t slope_capacity;
} GnsWorker;

typedef struct GnsFit {
    const GnsExamples *examples;
    GnsNet *net; /* its parameters are those of the pass */
    int batch, threads;
    GnsWorker *workers;    /* [threads] */
    float *transposed;     /* [parameters] */
    float *gradients;      /* [batch, parameters] */
    double *losses;        /* [batch] */
    double *mean_gradient; /* [parameters] of the batch; the block of these arrays */
} GnsFit;

/* False when memory is short; free it in any case. */
bool gns_fit_begin(GnsFit *fit, const GnsExamples *examples, GnsNet *net, int batch, Error *error);
void gns_fit_free(GnsFit *fit);

/* The mean loss of examples first to first + batch - 1, and its gradient; the same bits for any number of threads. */
bool gns_fit_batch(GnsFit *fit, uint64_t first, double *loss, Error *error);
