/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ways of stepping other than a contact solver in the standard step. */
#pragma once
#include "scene/scene.h"
#include "solvers/solvers.h"

#include <stdint.h>

/* Counts what a step costs beyond its contact problem, for who asks. */
typedef struct StepMeter {
    int64_t (*now)(void); /* time, instructions, whatever is counted */
    int64_t solving;      /* out: what passed from the contact problem to the solution */
} StepMeter;

/* What a method is told of the step that it takes. */
typedef struct Step {
    const Scene *scene; /* with the launch of this run */
    int frame;          /* number of the step: 1 .. frames */
    StepMeter *meter;   /* NULL: nobody asks */
} Step;

static inline void step_solving_begins(const Step *step) {
    if (step->meter != NULL) step->meter->solving = -step->meter->now();
}

static inline void step_solving_ends(const Step *step) {
    if (step->meter != NULL) step->meter->solving += step->meter->now();
}

typedef struct SteppingKind {
    MethodDescription description;
    /* Returns the state for a scene (its launch does not matter), NULL with error set where it is refused. */
    void *(*create)(const Settings *settings, const Scene *scene, Error *error);
    /* Advances the world by one step of the scene: begins, solves, ends it (dynamics/world.h). Allocates nothing once
       it has seen a problem of that size. */
    bool (*step)(void *state, World *world, const Step *step, Error *error);
    void (*destroy)(void *state);
} SteppingKind;

/* Listed in solvers/solvers.h. */
#define STEPPING_DECLARED(name) extern const SteppingKind stepping_##name;
METHODS(METHOD_OMITTED, STEPPING_DECLARED)
#undef STEPPING_DECLARED
