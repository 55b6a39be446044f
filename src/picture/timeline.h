/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Below the panels: the largest distance of each run from the first over time; logarithmic, as errors grow by powers
   of ten. */
#pragma once
#include "picture/picture.h"

/* Fills the picture's curves if the look shows them. */
bool timeline_plan(Picture *picture, Error *error);

/* Axes, curves, event lines, title and key. */
void timeline_draw_static(const Picture *picture, Drawing *drawing);

/* The current time and the runs' current distances. */
void timeline_draw_moving(const Picture *picture, Moment moment, Drawing *drawing);
