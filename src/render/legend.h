/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What outlines, colours, dots and arrows mean, in a row below the panels. */
#pragma once
#include "render/picture.h"

bool legend_is_needed(const Picture *picture);
void legend_draw(const Picture *picture, Drawing *drawing);
