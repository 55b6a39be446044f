/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of FLIP. Constants and equation numbers are the paper's. */
#pragma once
#include <stdint.h>

typedef struct FlipColor {
    float x, y, z; /* in any colour space */
} FlipColor;

/* linear_of[byte]: sRGB made linear, 0 to 1. */
void flip_make_linear(float linear_of[256]);

typedef enum FlipBackground { FLIP_WHITE, FLIP_BLACK } FlipBackground;

/* RGBA pixels on a background in a linear opponent space, in which lightness and the two chroma channels are blurred
   separately (section 4.1.1): lightness[count], red_green[count], blue_yellow[count]. */
void flip_load_row(const uint8_t *pixels, int count, FlipBackground background, const float linear_of[256],
                   float *lightness, float *red_green, float *blue_yellow);

/* From the opponent space to CIELab with the Hunt effect: less chroma at low lightness (section 4.1.2). */
FlipColor flip_hunt_lab(FlipColor opponent);

/* The distance between green and blue, the largest of all, raised as in flip_color_error(). */
float flip_largest_error(void);

/* 0 to 1, for two colours in CIELab (section 4.1.3); errors above a knee are compressed. */
float flip_color_error(FlipColor a, FlipColor b, float largest);

/* Equation 6: `color` amplified by the difference of edges or points, `feature`. */
float flip_amplify(float color, float feature);
