/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One panel: grid, bodies, axes, marks. */
#pragma once
#include "gl/stroke.h"
#include "picture/picture.h"

/* What keeps still: grid, static bodies, axes. Shapes of it lie behind all others. */
void panel_draw_still(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* The bodies that move, the bomb before them, and what the look adds. */
void panel_draw_moving(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* Where a point in metres lies in the picture. */
Point panel_point(const Picture *picture, int panel, double x, double y);

/* The shorter side of a panel in pixels: what lines are thick by. */
double panel_side(const Picture *picture);

/* How many dynamic bodies that are there lie with their centre outside the panel. */
int panel_count_unseen(const Picture *picture, int panel, Moment moment);
