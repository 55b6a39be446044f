/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of a whole picture, 0xRRGGBB: on white as in style.h, or on a dark page. */
#pragma once
#include "picture/look.h"
#include "picture/style.h"

typedef struct Theme {
    uint32_t page, panel, frame, grid, grid_strong, ink, ink_soft, ground, ground_line;
    uint32_t impulse, velocity; /* arrows */
    uint32_t event;             /* marks in the timeline */
    uint32_t ghost;             /* outlines of the first run over the others */
    BodyColors bomb;
    BodyColors bodies[LOOK_RUNS_MAX]; /* of each run */
    double ramp_near, ramp_far;       /* the ends of the colour scale: what is far stands out most */
} Theme;

const Theme *theme_get(LookTheme theme);

/* `share` of the way from one colour to another, 0 to 1. */
uint32_t theme_mix(uint32_t from, uint32_t to, double share);

/* A place on the colour scale, 0 to 1: yellow, green, teal, blue, violet, as light as 95 down to 13 in equal steps (CIE
   L*), so that it reads in grey and under every common colour blindness. */
uint32_t theme_ramp(const Theme *theme, double share);
