/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The grid of metres behind the bodies, and the numbers along its edges. */
#pragma once
#include "picture/picture.h"

void grid_draw_lines(const Picture *picture, int panel, Drawing *drawing);

/* Ticks and metres below every panel, and left of those in the first column: all have the same camera. */
void grid_draw_axes(const Picture *picture, int panel, Drawing *drawing);
