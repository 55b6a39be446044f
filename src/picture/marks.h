/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Optional marks in a panel: trails below the bodies, contacts and arrows above. */
#pragma once
#include "gl/stroke.h"
#include "picture/picture.h"

void marks_draw_below(const Picture *picture, int panel, Moment moment, Drawing *drawing);
void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* In pixels: radius of contact dots, thickness of trails and arrows. */
double marks_dot_radius(const Picture *picture);
double marks_line_thickness(const Picture *picture);
ArrowStyle marks_arrow_style(const Picture *picture, uint32_t color);
