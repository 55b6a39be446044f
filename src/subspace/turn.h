/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The angle of a sine and a cosine in a fixed sequence of operations, for the same bits with any maths library. */
#pragma once
#include <math.h>

/* Below this length a sine and a cosine give no direction. */
#define TURN_SHORTEST 1e-3f

/* atan(q) for 0 <= q <= 1, within 2e-6 rad. Abramowitz and Stegun, "Handbook of Mathematical Functions" (1964), 4.4.49,
   with coefficients to q^17. */
static inline float turn_arc(float q) {
    const float q2 = q * q;
    const float high =
        0.1065626393f + q2 * (-0.0752896400f + q2 * (0.0429096138f + q2 * (-0.0161657367f + q2 * 0.0028662257f)));
    return q * (1.0f + q2 * (-0.3333314528f + q2 * (0.1999355085f + q2 * (-0.1420889944f + q2 * high))));
}

/* The angle in rad, as near to `before` as whole turns allow; `before` itself if the two are too short to tell. */
static inline float turn_angle(float sine, float cosine, float before) {
    const float s = fabsf(sine), c = fabsf(cosine), most = s > c ? s : c, least = s > c ? c : s;
    if (!(most >= TURN_SHORTEST)) return before;
    const float eighth = turn_arc(least / most);
    const float quarter = s > c ? 1.57079633f - eighth : eighth;
    const float half = cosine < 0 ? 3.14159265f - quarter : quarter;
    const float angle = sine < 0 ? -half : half;
    /* Adding 1.5 * 2^23 rounds to an integer, as in network/activation.h. */
    const float shift = 0x1.8p23f, turns = ((before - angle) * 0.159154943f + shift) - shift;
    return angle + 6.28318531f * turns;
}
