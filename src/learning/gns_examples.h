/* SPDX-License-Identifier: GPL-3.0-or-later */
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
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "methods/methods.h"
#include "methods/gns_graph.h"
#include "scenes/scenes.h"

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
