/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What boxes look like: filled, and as outlines. Each into a panel and cut off at its edges. */
#pragma once
#include "picture/picture.h"

/* A run's body; of the bomb with its target. */
void body_draw(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing);

/* All static bodies of a run, or all that are not but the bomb. */
void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing);

/* The outlines of a run's dynamic bodies. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing);

/* A small box in the colours of the run's bodies, or as their outlines, standing on a line of text as high as `pixels`.
   Returns its right edge. */
int body_draw_swatch(const Picture *picture, int run, bool hollow, int left, int baseline, int pixels,
                     Drawing *drawing);
