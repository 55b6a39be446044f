/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One panel: grid, bodies, axes. */
#pragma once
#include "render/picture.h"

/* What keeps still: grid, static bodies, axes. Shapes of it lie behind all others. */
void panel_draw_still(const Picture *picture, int panel, int frame, Drawing *drawing);

/* The bodies that move, and the bomb before them. */
void panel_draw_moving(const Picture *picture, int panel, int frame, Drawing *drawing);

/* The bodies alone, those that move or those that do not; without the bomb. */
void panel_draw_bodies(const Picture *picture, int panel, int frame, bool fixed, Drawing *drawing);

/* How many dynamic bodies that are there lie with their centre outside the panel. */
int panel_count_unseen(const Picture *picture, int panel, int frame);

/* A small box in the colours of the panel's bodies, standing on a line of text. Returns its right edge. */
int panel_draw_swatch(const Picture *picture, int panel, int left, int baseline, Drawing *drawing);
