/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steppers: methods that need more than one solver call per step, or none. */
#pragma once
#include "scene/scene.h"
#include "solvers/solvers.h"

#include <stdint.h>

/* Measures the cost of the solver in a step. */
typedef struct StepMeter {
    int64_t (*now)(void); /* current count: time, instructions, ... */
    int64_t solving;      /* out: the count between contact problem and solution */
} StepMeter;

/* The step that a method takes. */
typedef struct Step {
    const Scene *scene; /* with the launch of the run */
    int frame;          /* number of the step, 1 .. frames */
    StepMeter *meter;   /* or NULL */
} Step;

static inline void step_solving_begins(const Step *step) {
    if (step->meter != NULL) step->meter->solving = -step->meter->now();
}

static inline void step_solving_ends(const Step *step) {
    if (step->meter != NULL) step->meter->solving += step->meter->now();
}

typedef struct SteppingKind {
    MethodDescription description;
    /* Returns the state for a scene with any launch; NULL with error set if the scene or a setting is refused. */
    void *(*create)(const Settings *settings, const Scene *scene, Error *error);
    /* Advances the world by one step of the scene: begins, solves and ends it (dynamics/world.h). Allocates
       nothing once it has seen a problem of that size. */
    bool (*step)(void *state, World *world, const Step *step, Error *error);
    void (*destroy)(void *state);
} SteppingKind;

/* Listed in solvers/solvers.h. */
#define STEPPING_DECLARED(name) extern const SteppingKind stepping_##name;
METHODS(METHOD_OMITTED, STEPPING_DECLARED)
#undef STEPPING_DECLARED
