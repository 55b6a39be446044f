/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rows of the picture change from one drawing to the next: most of a frame is like the one before. */
#pragma once
#include "gl/drawing.h"

/* Sets changed[y] for each of `height` rows. False where what keeps still has changed: then every row counts. */
bool damage_find(const Drawing *before, const Drawing *after, int height, bool *changed);
