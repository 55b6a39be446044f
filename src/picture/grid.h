/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The metre grid behind the bodies, and its labelled axes. */
#pragma once
#include "picture/picture.h"

void grid_draw_lines(const Picture *picture, int panel, Drawing *drawing);

/* Ticks and numbers below every panel, and left of the first column: all panels have the same camera. */
void grid_draw_axes(const Picture *picture, int panel, Drawing *drawing);
