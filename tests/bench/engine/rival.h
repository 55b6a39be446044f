/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One interface to all engines that are measured, so that each runs the same scene. */
#pragma once
#ifdef __cplusplus
extern "C" {
#endif

/* A box of a scene: SI units. */
typedef struct RivalBox {
    int fixed;
    float width, height, mass, friction, x, y, vx, vy;
} RivalBox;

typedef struct Rival {
    const char *name;
    void *(*create)(void); /* an empty world: gravity (0, -10), 10 iterations, no sleeping */
    void (*add)(void *world, const RivalBox *box);
    void (*step)(void *world); /* by 1/60 s */
    void (*destroy)(void *world);
} Rival;

extern const Rival rival_twinbox, rival_chipmunk, rival_box2d;

#ifdef __cplusplus
}
#endif
