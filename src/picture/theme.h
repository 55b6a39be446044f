/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of a whole picture, 0xRRGGBB: light as in style.h, or dark. */
#pragma once
#include "common/method_description.h"
#include "picture/look.h"
#include "picture/style.h"

typedef struct Theme {
    uint32_t page, panel, frame, grid, grid_strong, ink, ink_soft, ground, ground_line;
    uint32_t impulse, velocity; /* arrows */
    uint32_t event;             /* event lines in the timeline */
    BodyColors bomb;
    BodyColors bodies[METHOD_COLOURS]; /* by the colour of the run's method */
    bool ghost_is_band;         /* outlines of a run over others have the colour of its bands, else of its boxes */
    double ramp_near, ramp_far; /* range of the colour scale: large distances stand out most */
} Theme;

const Theme *theme_get(LookTheme theme);

/* Linear mix of two colours, `share` 0 to 1. */
uint32_t theme_mix(uint32_t from, uint32_t to, double share);

/* Position on the colour scale, 0 to 1: yellow, green, teal, blue, violet; CIE L* from 95 to 13 in equal steps, so
   that it is readable in grey and with all common kinds of colour blindness. */
uint32_t theme_ramp(const Theme *theme, double share);
