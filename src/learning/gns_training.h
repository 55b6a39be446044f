/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of the network of gns on single steps of recorded launches, by Adam with a falling rate. Source: see
   nets/kinds.h.

       bool ok = gns_training_run(&training, &net, progress, error) && gns_net_write(&net, "net.npz", error);
       gns_net_free(&net); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "methods/gns_graph.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

typedef struct GnsScore {
    int steps; /* so far */
    /* Mean squared errors in units of scales.acceleration: of the last epoch's examples, with their noise; of held-out
       examples. */
    double loss, held_out;
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
    void (*on_score)(void *context, const GnsScore *score); /* after each tenth of the steps; may be NULL */
    void *context;
} GnsTraining;

/* Makes the net, which the caller frees. False with error set if memory is short or a run fails. If progress requests a
   stop, the net is that of the steps so far; ERROR_INTERRUPTED while launches are recorded. The same bits for any
   number of threads. */
bool gns_training_run(const GnsTraining *training, GnsNet *net, const Progress *progress, Error *error);

/* Single steps of recorded launches, with noise on the inputs, for the network of gns. Source: section 4.3 and appendix
   of nets/kinds.h's.

       gns_examples_add(&examples, scene, &method, launches, progress, error);
       gns_example_make(&example, &examples, number); ... gns_example_free(&example), gns_examples_free(&examples);

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
    ArrayBlock arrays; /* of the particles, too */
} GnsExample;

void gns_example_free(GnsExample *example);

/* Example `number` of a seed: the same on every machine. Does not build the graph. False when memory is short. */
bool gns_example_make(GnsExample *example, const GnsExamples *examples, uint64_t number);
