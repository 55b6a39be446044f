/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The light theme's colours, 0xRRGGBB. The colours of bodies follow Okabe and Ito, distinguishable with all common
   kinds of colour blindness. Blue is the darkest, and the bomb is darker than any network's boxes, so that grey
   prints work. */
#pragma once
#include <stdint.h>

static const uint32_t PAGE = 0xF5F6F8, PANEL = 0xFFFFFF, FRAME = 0xC3C9D2;
static const uint32_t GRID = 0xF0F2F5, GRID_STRONG = 0xDFE3E9;
static const uint32_t INK = 0x1B2330, INK_SOFT = 0x667080;
static const uint32_t GROUND = 0xD3D8DF, GROUND_LINE = 0x5A6472;

typedef struct BodyColors {
    uint32_t fill, line, band; /* the band along the local top shows the rotation */
} BodyColors;

#define BOMB_COLORS \
    { 0xB5371B, 0x5E1606, 0xFFE9DF }
static const BodyColors BOMB = BOMB_COLORS;
