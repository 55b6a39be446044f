/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact problem as a relation network sees it: bodies, and for each moving body that touches something (a receiver)
   one row for each body that touches it (its senders). Two boxes that touch make two rows, a box on the ground makes
   one. Source: Battaglia, Pascanu, Lai, Rezende, Kavukcuoglu, "Interaction Networks for Learning about Objects,
   Relations and Physics" (2016); with an engine: Ajay, Bauza, Wu, Fazeli, Tenenbaum, Rodriguez, Kaelbling, "Combining
   Physical Simulators and Object-Based Networks for Control" (2019).

   Frame: the axes of the receiver, turned by quarter turns so that its first axis is as near to the world's x as
   possible. A contact problem has no preferred direction, as its velocities have felt gravity already, so the same
   collision looks the same at any tilt, and a box after a quarter turn looks as before.

   Scale: impulses are proportional to velocities, but for friction and stopping, so velocities are divided by the
   receiver's pace, which sums up what happens to it: the same network serves a touch and a crash. Velocities relative
   to the world have no bound even then and become v / (pace + |v|). The pose of a sender is where and along which
   normal the two touch: the centre of the ground, ten metres below, says nothing. Mass is the receiver's share of the
   inverse masses, which is all that velocities depend on. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"

#include <stddef.h>

#define SAIN_ENGINE_SETTINGS "k=10" /* of the method engine: as Box2D's own standard */

enum { SAIN_PAIR_INPUTS = 27, SAIN_BODY_INPUTS = 10, SAIN_OUTPUTS = 3 };

/* A receiver. */
typedef struct SainBody {
    int body;          /* in the problem */
    int first, rows;   /* of its senders */
    Vec2 axis;         /* first axis of its frame, in the world */
    float radius;      /* m, of gyration: spins are multiplied by it */
    float pace, scale; /* m/s: of the inputs, of the outputs */
    BodyVelocity base; /* to which outputs are added */
} SainBody;

/* Work space; zero-initialise, free with sain_view_free. */
typedef struct SainView {
    int body_count, row_count;
    SainBody *bodies;   /* [body_count] by rising index in the problem */
    float *pair_inputs; /* [SAIN_PAIR_INPUTS, row_count] */
    float *body_inputs; /* [SAIN_BODY_INPUTS, body_count] */
    /* while it is made: */
    BodyVelocity *changed; /* [bodies of the problem] after what the engine did */
    BodyVelocity *warmed;  /* [bodies of the problem] after the impulses of the step before */
    int *receivers;        /* [bodies of the problem] index in bodies, or -1 */
    struct SainViewRow *rows;
    ArrayBlock arrays;
} SainView;

void sain_view_free(SainView *view);

/* Looks at a problem. engine: its velocities [problem->body_count] after the step. False when memory is short.
   Allocates nothing for a problem that is not larger than one before. */
bool sain_view_make(SainView *view, const ContactProblem *problem, const BodyVelocity *engine);

/* A vector of the world in the receiver's frame, and back. */
static inline Vec2 sain_into_frame(const SainBody *body, Vec2 v) {
    return vec2(vec2_dot(body->axis, v), vec2_cross(body->axis, v));
}

static inline Vec2 sain_out_of_frame(const SainBody *body, Vec2 v) {
    return mat22_multiply((Mat22){body->axis, vec2(-body->axis.y, body->axis.x)}, v);
}

/* The velocity of a receiver for these outputs[SAIN_OUTPUTS]: base + scale * outputs, turned back. */
BodyVelocity sain_corrected(const SainBody *body, const float *outputs);

/* The outputs that would give this velocity (double: a converged one), times the scale, m/s. */
void sain_target(const SainBody *body, double x, double y, double spin, double target[SAIN_OUTPUTS]);
