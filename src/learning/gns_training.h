/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of the network of gns on single steps of recorded launches, by Adam with a falling rate. Source: see
   nets/kinds.h.

       bool ok = gns_training_run(&training, &net, progress, error) && gns_net_write(&net, "net.npz", error);
       gns_net_free(&net); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/gns_examples.h"
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
