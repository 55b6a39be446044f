/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A heap of boxes as particles, and a network with random parameters. */
#pragma once
#include "testing.h"

#include "base/base.h"
#include "base/random.h"
#include "methods/gns_graph.h"

enum { HEAP_BODIES = 7, HEAP_PARTICLES = HEAP_BODIES * BOX_PARTICLES };

typedef struct ParticleHeap {
    GnsBody body[HEAP_BODIES];
    Vec2 position[HEAP_PARTICLES], velocity[HEAP_PARTICLES][GNS_HISTORY];
    Box ground;
    GnsParticles particles;
} ParticleHeap;

static inline float random_between(uint64_t *random, double least, double most) {
    return (float)(least + (most - least) * (double)(split_mix(random) >> 11) * 0x1p-53);
}

/* `order` lists the bodies. */
static inline void make_heap(ParticleHeap *heap, const int order[HEAP_BODIES]) {
    for (int i = 0; i < HEAP_BODIES; i++) {
        const int body = order[i];
        uint64_t random = 77 + (uint64_t)body;
        const BodyPose pose = {{0.7f * (float)(body % 3), 0.5f + 0.9f * (float)(body / 3)}, 0.1f * (float)body};
        heap->body[i] = (GnsBody){{1, 1}, body == 2 ? 5 : 1, body == 2};
        box_particles_place(heap->position + (ptrdiff_t)i * BOX_PARTICLES, heap->body[i].size, &pose);
        for (int p = i * BOX_PARTICLES; p < (i + 1) * BOX_PARTICLES; p++)
            for (int k = 0; k < GNS_HISTORY; k++) {
                /* One after the other: compilers differ in the order of a call's arguments. */
                const float upwards = random_between(&random, -2, 2);
                heap->velocity[p][k] = vec2(random_between(&random, -2, 2), upwards);
            }
    }
    heap->ground = box_make(vec2(0, -10), vec2(100, 20), 0);
    heap->particles = (GnsParticles){HEAP_BODIES, heap->body, heap->position, heap->velocity};
}

static const int heap_order[HEAP_BODIES] = {0, 1, 2, 3, 4, 5, 6};

static inline void make_net(GnsNet *net, int width, int rounds) {
    Error error = {0};
    uint64_t random = 5;
    assert_ok(gns_net_create(net, width, rounds, &error), error);
    for (int i = 0; i < net->layout.parameters; i++) net->parameters[i] = random_between(&random, -0.4, 0.4);
    net->scales = (GnsScales){0.6f, 3, 20, 30, 1000};
    net->gravity[1] = -10;
}
