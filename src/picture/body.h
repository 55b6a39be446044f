/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws boxes, filled or as outlines, into a panel and clipped to it. */
#pragma once
#include "picture/picture.h"

/* Draws a body of a run; the bomb with its target. */
void body_draw(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing);

/* Draws all static bodies of a run (`fixed`), or all dynamic bodies except the bomb. */
void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing);

/* Draws the outlines of a run's dynamic bodies. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing);

/* Draws a small box in the run's colours, filled or as outline, on the baseline of text of this size. Returns its
   right edge. */
int body_draw_swatch(const Picture *picture, int run, bool hollow, int left, int baseline, int pixels,
                     Drawing *drawing);
