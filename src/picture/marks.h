/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the look adds to a panel's bodies: their trails below them, contacts and arrows above. */
#pragma once
#include "gl/stroke.h"
#include "picture/picture.h"

void marks_draw_below(const Picture *picture, int panel, Moment moment, Drawing *drawing);
void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* Lines of marks in pixels: contacts' radius, and the thickness of trails and arrows. */
double marks_dot(const Picture *picture);
double marks_line(const Picture *picture);
ArrowStyle marks_arrow(const Picture *picture, uint32_t color);
