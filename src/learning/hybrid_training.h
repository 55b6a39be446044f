/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of hybrid: its memory of impacts (methods/hybrid_memory.h), launch after launch.

       HybridMemory *memory = hybrid_training_run(scene, &training, progress, error);
       bool ok = memory != NULL && hybrid_memory_write(memory, "memory.npz", error);

   The memory is frozen within a launch, and grows between launches from the steps that it did not answer. The first
   launches find the principal directions of the keys; every tenth launch solves the answered steps, too, and corrects
   the ellipsoids of wrong answers. Sources: methods/hybrid_memory.h. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "methods/hybrid_memory.h"
#include "scenes/scenes.h"

#include <stdint.h>

enum { HYBRID_STANDARD_COMPONENTS = 12, HYBRID_LAUNCHES_MAX = 1000000 };

/* A launch, learned. */
typedef struct HybridLaunch {
    int number;                 /* from 1 */
    int asked, answered;        /* steps that asked the memory; of these, that it answered */
    int grown, added, full;     /* of the others: an ellipsoid took it in; an entry; no room for an entry */
    int checked;                /* answers compared with the converged solution */
    double error;               /* m/s: sum of their errors */
    float grown_error;          /* m/s: the largest of an answer that an ellipsoid took in */
    const HybridMemory *memory; /* after the launch; NULL until there are directions */
} HybridLaunch;

typedef struct HybridTraining {
    int launches;    /* in all, drawn by seed and number from the scene's family */
    int steps;       /* that each launch runs from the bomb's first touch */
    int components;  /* of the keys */
    float tolerance; /* m/s */
    size_t limit;    /* bytes */
    uint64_t seed;
    /* Called after each launch; may be NULL. */
    void (*on_launch)(void *context, const HybridLaunch *launch);
    void *context;
} HybridTraining;

/* NULL with error set: a scene without a bomb, launches that touch nothing, memory. If progress stops it, the memory
   so far is returned; ERROR_INTERRUPTED if it has none yet. The same bits for any number of threads. */
HybridMemory *hybrid_training_run(const Scene *scene, const HybridTraining *training, const Progress *progress,
                                  Error *error);
