/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of soft-step (soft_step.c): its state in a step, and its substeps. */
#pragma once
#include "simulate/step_memory.h"

/* c, 1 - c and c r of the equation in soft_step.c. */
typedef struct Softness {
    float mass_share, impulse_share, bias_rate;
} Softness;

typedef struct SoftBody {
    Vec2 velocity;
    float spin, inv_mass, inv_inertia;
    Vec2 moved; /* m, since the step began */
    Vec2 turn;  /* (cos, sin) of the rotation since the step began */
} SoftBody;

typedef struct SoftPoint {
    Vec2 arm_a, arm_b;
    float base;                      /* m, separation if the arms had no length */
    float mass_normal, mass_tangent; /* kg */
    ContactImpulse impulse;          /* N s, of a substep: what the next one begins with */
    ContactImpulse total;            /* N s, of the step */
} SoftPoint;

typedef struct SoftPair {
    int a, b, first, count; /* bodies; points */
    Vec2 normal;
    float friction;
    const Softness *softness;
} SoftPair;

typedef struct SoftStep {
    int substeps;
    float hertz, damping;
    Softness moving, fixed; /* of contacts between moving bodies; with a static body: twice the frequency */
    StepMemory memory;
    SoftBody *bodies;
    BodyPose *poses;
    SoftPair *pairs;
    SoftPoint *points;
    ContactImpulse *kept; /* [contacts of the last step] impulses of its last substep */
    int pair_count, body_count, point_count;
    size_t body_capacity, pose_capacity, pair_capacity, point_capacity, kept_capacity;
} SoftStep;

/* Takes all substeps of a step that has begun: moves bodies and poses, fills the points' impulses. */
void soft_step_solve(SoftStep *stepping, Vec2 gravity, float dt);
