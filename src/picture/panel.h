/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One panel: grid, bodies, axes, marks. */
#pragma once
#include "gl/stroke.h"
#include "picture/picture.h"

/* The static layer: grid, static bodies, axes. Its shapes are behind all others. */
void panel_draw_static(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* The dynamic bodies, the bomb on top, and the marks. */
void panel_draw_moving(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* Converts a point from metres to pixels of the picture. */
Point panel_point(const Picture *picture, int panel, double x, double y);

/* The shorter side of a panel in pixels; line thicknesses are relative to it. */
double panel_side(const Picture *picture);

/* The number of dynamic bodies whose centre is outside the panel. */
int panel_count_out_of_view(const Picture *picture, int panel, Moment moment);
