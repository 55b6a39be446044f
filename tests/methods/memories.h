/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small memories, made by hand. */
#pragma once
#include "testing.h"

#include "methods/hybrid_memory.h"

enum { BODIES = 3, COMPONENTS = 2, KEY = HYBRID_NUMBERS + COMPONENTS + 1, METRIC = KEY * (KEY + 1) / 2 };

static inline float any_number(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 8388608.0f - 1;
}

static inline HybridMemory *make_memory(void) {
    Error error = {0};
    HybridMemory *memory = hybrid_memory_create(BODIES, 2, COMPONENTS, &error);
    assert_ok(memory != NULL, error);
    memory->gate = 0.3f;
    memory->tolerance = 0.1f;
    strcpy(memory->scene, "hand");
    return memory;
}

/* An entry for `contacts` contacts with hash 7 + contacts, impulses (n, n / 10) with n = first + contact, a ball of
   this radius, and neighbours with weights; both NULL: none. Returns its index. */
static inline int add_entry(HybridMemory *memory, int contacts, const float *key, float first, float radius,
                            const int32_t *near, const float *weights) {
    Error error = {0};
    static const int32_t nobody[HYBRID_NEAR] = {-1, -1, -1};
    static const float none[HYBRID_NEAR * KEY];
    ContactImpulse impulses[8];
    float metric[METRIC];
    for (int i = 0; i < contacts; i++) impulses[i] = (ContactImpulse){first + (float)i, (first + (float)i) / 10};
    for (int i = 0, k = 0; i < KEY; i++)
        for (int j = 0; j <= i; j++) metric[k++] = i == j ? 1 / (radius * radius) : 0;
    const HybridQuery query = {7 + (uint64_t)contacts, contacts, key};
    const HybridEntry entry = {impulses, near != NULL ? near : nobody, weights != NULL ? weights : none, metric,
                               radius * radius};
    assert_ok(hybrid_memory_add(memory, &query, &entry, &error), error);
    return memory->entry_count - 1;
}
