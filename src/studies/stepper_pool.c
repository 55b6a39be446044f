/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steppers that threads use in turns. */
#include "base/base.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"
#include "studies/stepper_pool.h"

#include <omp.h>
#include <stdlib.h>

struct PooledStepper {
    omp_lock_t taken;
    Stepper *stepper; /* NULL: not made yet */
    SharedSteps shared;
};

bool stepper_pool_begin(StepperPool *pool, int count, Error *error) {
    *pool = (StepperPool){.items = calloc((size_t)count + 1, sizeof *pool->items)};
    if (pool->items == NULL) return error_memory(error, "study");
    for (; pool->count < count; pool->count++) omp_init_lock(&pool->items[pool->count].taken);
    return true;
}

void stepper_pool_end(StepperPool *pool) {
    stepper_pool_empty(pool);
    for (int i = 0; i < pool->count; i++) omp_destroy_lock(&pool->items[i].taken);
    free(pool->items);
    *pool = (StepperPool){0};
}

void stepper_pool_empty(StepperPool *pool) {
    for (int i = 0; i < pool->count; i++) {
        stepper_destroy(pool->items[i].stepper);
        pool->items[i].stepper = NULL;
        shared_steps_free(&pool->items[i].shared);
    }
}

/* *free: it is taken, as no other thread had it. */
static int stepper_pool_choose(StepperPool *pool, const bool *chosen, int from, bool *free) {
    int found = -1;
    for (int k = 0; k < pool->count; k++) {
        const int i = (from + k) % pool->count;
        if (chosen[i]) continue;
        *free = omp_test_lock(&pool->items[i].taken) != 0;
        if (*free) return i;
        if (found < 0) found = i;
    }
    return found;
}

int stepper_pool_take(StepperPool *pool, bool *chosen, int from) {
    int index;
    bool free = false;
#pragma omp critical(stepper_pool)
    {
        index = stepper_pool_choose(pool, chosen, from, &free);
        chosen[index] = true;
    }
    if (!free) omp_set_lock(&pool->items[index].taken);
    return index;
}

void stepper_pool_give(StepperPool *pool, int index) { omp_unset_lock(&pool->items[index].taken); }

SharedSteps *stepper_pool_shared(StepperPool *pool, int index) { return &pool->items[index].shared; }

Stepper *stepper_pool_stepper(StepperPool *pool, int index, const Method *method, const Scene *scene, Error *error) {
    PooledStepper *item = &pool->items[index];
    if (item->stepper == NULL) item->stepper = stepper_create(method, scene, error);
    return item->stepper;
}
