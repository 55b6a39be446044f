/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of hybrid: its memory of impacts, launch after launch. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/hybrid_memory.h"
#include "scenes/scenes.h"

#include <stdint.h>

/* What a memory learns from a solved impact: nothing, a larger ellipsoid, or a new entry. Source: Pope (1997), 3, and
   Lu, Pope (2009) for the checks of answers; the linear map is a fit over neighbours instead of a derivative
   (hybrid_memory.h).

   A derivative by finite differences would take a converged solve for each direction of the key, most of which no
   launch takes, and the contacts change their features under small turns. The fit takes none, and is exact along the
   launches. */

/* RMS over the dynamic bodies of |dv|^2 + dspin^2 / 6, as in methods/reference.h, m/s. */
float velocity_error(const ContactProblem *problem, const BodyVelocity *a, const BodyVelocity *b);

/* A step, solved to convergence. */
typedef struct SolvedStep {
    const ContactProblem *problem;
    const ContactSolution *solution;
    HybridQuery query;
} SolvedStep;

typedef enum Lesson {
    LESSON_KNOWN, /* the memory answers it by now */
    LESSON_GROWN, /* an ellipsoid includes it */
    LESSON_ADDED, /* an entry */
    LESSON_FULL   /* an entry would exceed the limit */
} Lesson;

/* limit: bytes of the memory. answer: work space of the problem's size. False with error set when memory is short. */
bool entry_learn(HybridMemory *memory, const SolvedStep *step, size_t limit, ContactSolution *answer, Lesson *lesson,
                 Error *error);

/* Checks an entry that answered the step: if the answer's error exceeds the tolerance, its ellipsoid shrinks. Returns
   the error, m/s. */
float entry_check(HybridMemory *memory, int entry, const SolvedStep *step, ContactSolution *answer);

/* Runs launches by hybrid, one after the other, and keeps the steps that ask the memory. */

/* A step that asked the memory, with copies of all. */
typedef struct AskedStep {
    ContactProblem problem; /* its arrays are in `block`, as those of the solution */
    ContactSolution solution;
    uint64_t hash;
    float bomb[HYBRID_NUMBERS];
    float *others; /* [6 (body_count - 1)] */
    int entry;     /* that answered, or -1: the solution is converged */
    char *block;
} AskedStep;

/* Zero-initialise. */
typedef struct AskedSteps {
    AskedStep *items;
    int count;
    size_t capacity;
    int64_t steps;  /* of the launches so far, asked or not */
    double seconds; /* that the copies took */
} AskedSteps;

/* Empties the list and its sums; its array is kept for the next launch. */
void asked_steps_clear(AskedSteps *steps);
void asked_steps_free(AskedSteps *steps);

/* The world of the scene, which must have a bomb, just before the bomb appears. NULL with error set. */
World *hybrid_prefix(const Scene *scene, Error *error);

/* Runs one launch from that world up to `steps` steps from the bomb's first touch, and appends the asked ones. The
   memory, or NULL, is not changed. A launch ends if its state becomes NaN or infinite. */
bool launch_steps_run(const Scene *scene, const World *prefix, const Launch *launch, const HybridMemory *memory,
                      int steps, AskedSteps *asked, Error *error);

/* Fills the memory of hybrid (methods/hybrid.c): launch after launch, with the memory frozen within a launch and grown
   between launches from the steps that it did not answer. The first launches find the principal directions of the keys;
   every tenth launch after them solves the answered steps, too, and corrects the ellipsoids of wrong answers. Sources:
   methods/hybrid_memory.h. */

/* Keys of the first HYBRID_FIRST launches are fitted. */
enum { HYBRID_FIRST = 40, HYBRID_STANDARD_COMPONENTS = 12, HYBRID_CHECK_EVERY = 10, HYBRID_LAUNCHES_MAX = 1000000 };

/* A launch, learned. */
typedef struct HybridLaunch {
    int number;                 /* from 1 */
    int64_t steps;              /* that it ran with the bomb */
    int asked, answered;        /* of these */
    int grown, added, full;     /* lessons */
    int checked;                /* answers compared with the converged solution */
    double error;               /* m/s: sum of their errors */
    double learning;            /* s: processor time of copies of steps, fits, growth and checks */
    const HybridMemory *memory; /* after the launch; NULL until there are directions */
} HybridLaunch;

typedef struct HybridTraining {
    int launches; /* in all */
    /* from this launch on, counted from 0, bombs have a random rotation and spin; negative: only if the scene's family
       has */
    int turned_from;
    int steps;       /* that each launch runs from the bomb's first touch */
    int components;  /* of the keys */
    float tolerance; /* m/s */
    size_t limit;    /* bytes */
    uint64_t seed;
    const char *command;    /* stored */
    const char *state_path; /* of an interrupted training; NULL: none is kept */
    /* Called after each launch; may be NULL. False with error set stops the training. */
    bool (*on_launch)(void *context, const HybridLaunch *launch, Error *error);
    void *context;
} HybridTraining;

/* Launch i of such a training, from 0; turned: with a random rotation and spin. */
Launch hybrid_launch(const Scene *scene, uint64_t seed, int i, bool turns);

/* NULL with error set: a scene without a bomb, launches that touch nothing, memory. If progress stops it, the state is
   stored and the memory so far returned; ERROR_INTERRUPTED if it has none yet. The same bits for any number of
   threads. */
HybridMemory *hybrid_training_run(const Scene *scene, const HybridTraining *training, const Progress *progress,
                                  Error *error);

/* The principal directions of a memory's keys. */

/* others: [count, memory->numbers] numbers of the bodies but the bomb in `count` > 0 steps. Sets the memory's centre to
   their mean and its rows to their strongest directions. False with error set when memory is short, or if a number is
   not finite. */
bool key_fit(HybridMemory *memory, const float *others, int count, uint64_t seed, Error *error);
