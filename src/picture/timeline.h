/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest distance of each run from the first over time, below the panels; logarithmic, as errors grow by powers. */
#pragma once
#include "picture/picture.h"

/* Fills the picture's curves where the look shows them. */
bool timeline_plan(Picture *picture, Error *error);

/* Axes, curves and marks of the events; the words above. */
void timeline_draw_still(const Picture *picture, Drawing *drawing);

/* Where the moment is, and each run there. */
void timeline_draw_moving(const Picture *picture, Moment moment, Drawing *drawing);
