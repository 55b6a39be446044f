/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/theme.h"

#include <math.h>

/* The hues of methods are Okabe and Ito's (2008); wine, from Tol (2021), replaces yellow, which is too light for lines. */
static const Theme light = {
    .page = PAGE,
    .panel = PANEL,
    .frame = FRAME,
    .grid = GRID,
    .grid_strong = GRID_STRONG,
    .ink = INK,
    .ink_soft = INK_SOFT,
    .ground = GROUND,
    .ground_line = GROUND_LINE,
    .impulse = 0x10161F,
    .velocity = 0xA3005C,
    .event = 0x8A94A3,
    .ghost_is_band = false,
    .bomb = BOMB_COLORS,
    .bodies =
        {
            [METHOD_BLUE] = {0x0072B2, 0x00395C, 0x4FA6D8},
            [METHOD_ORANGE] = {0xE69F00, 0x7A4F00, 0xFFD47A},
            [METHOD_GREEN] = {0x009E73, 0x004D38, 0x5CCBAA},
            [METHOD_PURPLE] = {0xCC79A7, 0x6E2F52, 0xEBBBD5},
            [METHOD_SKY] = {0x56B4E9, 0x1D5F87, 0xB5DFF7},
            [METHOD_WINE] = {0x882255, 0x3F0F27, 0xC98BA6},
            [METHOD_VERMILION] = {0xD55E00, 0x6B2F00, 0xF7B07A},
            [METHOD_BLACK] = {0x181D24, 0x000000, 0x8D99A8},
        },
    .ramp_near = 0,
    .ramp_far = 1,
};

/* The same hues; line and band colours are exchanged, as light colours stand out on a dark page. */
static const Theme dark = {
    .page = 0x12161C,
    .panel = 0x1A2028,
    .frame = 0x465161,
    .grid = 0x222A34,
    .grid_strong = 0x313B48,
    .ink = 0xEDF1F6,
    .ink_soft = 0x9AA6B6,
    .ground = 0x343E4B,
    .ground_line = 0x93A0B1,
    .impulse = 0xF7F9FB,
    .velocity = 0xFF8AC4,
    .event = 0x77849A,
    .ghost_is_band = true,
    .bomb = {0xE4573A, 0x3D0D03, 0xFFF1EA},
    .bodies =
        {
            [METHOD_BLUE] = {0x2A86C4, 0x061D2D, 0x8CCBF0},
            [METHOD_ORANGE] = {0xE9A92A, 0x3B2600, 0xFFE3A3},
            [METHOD_GREEN] = {0x1FAE85, 0x02271C, 0x8FE3C8},
            [METHOD_PURPLE] = {0xD58BB4, 0x3A132A, 0xF6D3E5},
            [METHOD_SKY] = {0x6FC1F0, 0x0F3349, 0xD0ECFC},
            [METHOD_WINE] = {0xB0487D, 0x2A0818, 0xE8B4CE},
            [METHOD_VERMILION] = {0xE2762A, 0x3A1600, 0xFFC9A0},
            [METHOD_BLACK] = {0xC3CCD7, 0x232A33, 0xF2F5F8}, /* white here: what is most unlike the page */
        },
    .ramp_near = 0.86,
    .ramp_far = 0,
};

const Theme *theme_get(LookTheme theme) { return theme == LOOK_DARK ? &dark : &light; }

static uint32_t mix_channel(uint32_t from, uint32_t to, int shift, double share) {
    double a = from >> shift & 255, b = to >> shift & 255;
    return (uint32_t)rint(a + (b - a) * share) << shift;
}

uint32_t theme_mix(uint32_t from, uint32_t to, double share) {
    return mix_channel(from, to, 16, share) | mix_channel(from, to, 8, share) | mix_channel(from, to, 0, share);
}

uint32_t theme_ramp(const Theme *theme, double share) {
    /* Oklab: hue 104 to 295 degrees, chroma 0.135 or the most that sRGB can show, lightness fitted to CIE L*. */
    static const uint32_t stops[] = {0xFEF483, 0xC6E57E, 0x8AD482, 0x46C18C, 0x02A995, 0x0B8F95,
                                     0x08778E, 0x005E89, 0x04438D, 0x272879, 0x2E085E};
    enum { LAST = sizeof stops / sizeof stops[0] - 1 };
    double at = LAST * (theme->ramp_near + (theme->ramp_far - theme->ramp_near) * fmin(fmax(share, 0), 1));
    int below = at < LAST - 1 ? (int)at : LAST - 1;
    return theme_mix(stops[below], stops[below + 1], at - below);
}
