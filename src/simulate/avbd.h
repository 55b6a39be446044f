/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of avbd (avbd.c): its state in a step, the step's start, and its passes. */
#pragma once
#include "simulate/step_memory.h"

#define AVBD_PENALTY_MIN 1.0f /* N/m */
#define AVBD_PENALTY_MAX 1e9f /* N/m */

/* A displacement or its gradient. */
typedef struct Vec3 {
    float x, y, turn;
} Vec3;

typedef struct AvbdBody {
    Vec3 moved, free;    /* displacement in this step; without contacts */
    Vec2 start;          /* m/s, velocity at the start of the step */
    float mass, inertia; /* over dt^2; 0: static */
    int first, count;    /* its visits */
} AvbdBody;

/* Along the normal or the tangent of a contact. */
typedef struct AvbdRow {
    Vec3 of_a, of_b; /* gradient of the gap */
    float start;     /* m, gap at the start of the step */
    float penalty;   /* N/m */
    float force;     /* N, the multiplier; on b */
} AvbdRow;

typedef struct AvbdContact {
    int a, b;
    float friction;
    Vec2 point_a, point_b; /* m, on each body, in its own frame */
    bool sticks;
    AvbdRow normal, tangent;
} AvbdContact;

typedef struct Avbd {
    int iterations;
    float alpha, beta, gamma; /* alpha < 0: post-stabilization */
    StepMemory memory;
    AvbdBody *bodies;
    Mat22 *rotations;             /* [bodies] */
    BodyPose *poses;              /* [bodies] */
    Vec2 *before;                 /* [bodies of the last step] velocity at its start */
    AvbdContact *contacts, *last; /* [contacts] of this step and the last */
    int *visits;                  /* [2 contacts] contacts of a body, body after body */
    int body_count, contact_count;
    size_t body_capacity, rotation_capacity, pose_capacity, before_capacity, contact_capacity, last_capacity,
        visit_capacity;
} Avbd;

/* Fills the state for a step of the world that has begun. False when memory is short. */
bool avbd_begin(Avbd *avbd, const World *world, const ContactProblem *problem, const Step *step);

/* Makes the passes of a step: moves the bodies, fills the velocities of the solution. */
void avbd_solve(Avbd *avbd, const Step *step, const ContactProblem *problem, ContactSolution *solution);
