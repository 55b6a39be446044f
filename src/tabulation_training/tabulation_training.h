/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fills the memory of hybrid (solvers/hybrid.c): launch after launch, with the memory frozen within a launch and grown
   between launches from the steps that it did not answer. The first launches find the principal directions of the keys;
   every tenth launch after them solves the answered steps, too, and corrects the ellipsoids of wrong answers. Sources:
   tabulation/tabulation.h. */
#pragma once
#include "common/progress.h"
#include "scene/launch.h"
#include "tabulation/tabulation.h"

/* Keys of the first TABULATION_FIRST launches are fitted. */
enum {
    TABULATION_FIRST = 40,
    TABULATION_STANDARD_COMPONENTS = 12,
    TABULATION_CHECK_EVERY = 10,
    TABULATION_LAUNCHES_MAX = 1000000
};

/* A launch, learned. */
typedef struct TabulationLaunch {
    int number;               /* from 1 */
    int64_t steps;            /* that it ran with the bomb */
    int asked, answered;      /* of these */
    int grown, added, full;   /* lessons (entry_fit.h) */
    int checked;              /* answers compared with the converged solution */
    double error;             /* m/s: sum of their errors */
    double learning;          /* s: processor time of copies of steps, fits, growth and checks */
    const Tabulation *memory; /* after the launch; NULL until there are directions */
} TabulationLaunch;

typedef struct TabulationTraining {
    int launches;    /* in all */
    int turned_from; /* from this launch on, counted from 0, bombs have a random rotation and spin; negative: only if the
                        scene's family has */
    int steps;       /* that each launch runs from the bomb's first touch */
    int components;  /* of the keys */
    float tolerance; /* m/s */
    size_t limit;    /* bytes */
    uint64_t seed;
    const char *command;    /* stored */
    const char *state_path; /* of an interrupted training; NULL: none is kept */
    /* Called after each launch; may be NULL. False with error set stops the training. */
    bool (*on_launch)(void *context, const TabulationLaunch *launch, Error *error);
    /* Called with each step that becomes an entry; may be NULL. Does not count as time of learning. */
    bool (*on_added)(void *context, const ContactProblem *problem, Error *error);
    void *context;
} TabulationTraining;

/* Launch i of such a training, from 0; turned: with a random rotation and spin. */
Launch tabulation_launch(const Scene *scene, uint64_t seed, int i, bool turns);

/* NULL with error set: a scene without a bomb, launches that touch nothing, memory. If progress stops it, the state is
   stored and the memory so far returned; ERROR_INTERRUPTED if it has none yet. The same bits for any number of threads. */
Tabulation *tabulation_training_run(const Scene *scene, const TabulationTraining *training, const Progress *progress,
                                    Error *error);
