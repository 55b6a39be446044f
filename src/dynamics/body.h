/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rigid box. */
#pragma once
#include "common/vec2.h"

#include <stdbool.h>

/* The definition of a body. Zero-initialise, then set at least size and mass. */
typedef struct BodyDef {
    Vec2 size;              /* full width and height, m, > 0 */
    bool fixed;             /* static: infinite mass */
    float mass;             /* kg, > 0; ignored where fixed */
    float friction;         /* coefficient, >= 0; a pair has sqrt(f1 f2) */
    Vec2 position;          /* m */
    float angle;            /* rad */
    Vec2 velocity;          /* m/s */
    float angular_velocity; /* rad/s */
} BodyDef;

typedef struct Body {
    Vec2 position;
    float angle;
    Vec2 velocity;
    float angular_velocity;
    Vec2 size;
    float friction;
    float inv_mass, inv_inertia; /* 0 if static */
} Body;
