/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stepper for each of several methods of a scene. Threads use them in turns, as some take seconds and much
   memory to be made. A stepper keeps nothing of a launch for the next, so the order of launches does not matter. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"

#include <stdbool.h>

typedef struct PooledStepper PooledStepper;

typedef struct StepperPool {
    PooledStepper *items; /* [count] */
    int count;
} StepperPool;

bool stepper_pool_begin(StepperPool *pool, int count, Error *error);
void stepper_pool_end(StepperPool *pool);

/* Destroys the steppers, which no thread may use; they are made again when they are needed. */
void stepper_pool_empty(StepperPool *pool);

/* Chooses a method that is not marked in chosen[count], from `from` on, and marks it: one that no other thread uses, or
   else one that it waits for. Returns its index; stepper_pool_give() must follow. */
int stepper_pool_take(StepperPool *pool, bool *chosen, int from);
void stepper_pool_give(StepperPool *pool, int index);

/* The first steps of all launches by the method that was taken: kept as long as its stepper; zero at first. */
SharedSteps *stepper_pool_shared(StepperPool *pool, int index);

/* The stepper of the method that was taken. NULL with error set if it cannot be made. */
Stepper *stepper_pool_stepper(StepperPool *pool, int index, const Method *method, const Scene *scene, Error *error);
