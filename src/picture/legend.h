/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What outlines, colours, dots and arrows mean, in rows below the panels. */
#pragma once
#include "picture/picture.h"

/* How many rows it takes in the picture's width; 0: there is nothing to explain. */
int legend_rows(const Picture *picture);
void legend_draw(const Picture *picture, Drawing *drawing);
