/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The legend of outlines, colours, dots and arrows, in rows below the panels. */
#pragma once
#include "picture/picture.h"

/* The rows it needs at the picture's width; 0: nothing to explain. */
int legend_rows(const Picture *picture);
void legend_draw(const Picture *picture, Drawing *drawing);
