/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains the network of gns on single steps of recorded launches (gns_examples.h) by Adam with a falling rate. Source:
   gns_net.h. */
#pragma once
#include "common/progress.h"
#include "particles_training/gns_examples.h"

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

/* Makes the net, which the caller frees. False with error set if the state cannot be written or read, memory is short or a
   run fails. ERROR_INTERRUPTED if progress requests a stop: the state stays. The same bits for any number of threads, and
   however often it was interrupted. */
bool gns_training_run(GnsTraining *training, GnsNet *net, const Progress *progress, Error *error);

/* The time of a forward pass with its neighbour search, on one thread, over all boxes of the recorded scene once the bomb is
   there: their number in *boxes. The least of a few. */
bool gns_training_time_pass(const GnsNet *net, const GnsRuns *runs, double *seconds, int *boxes, Error *error);
