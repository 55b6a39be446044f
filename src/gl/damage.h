/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Damage tracking: the rows of the picture that change from one drawing to the next. Most of a frame equals the one
   before. */
#pragma once
#include "gl/drawing.h"

/* Sets changed[y] for each of `height` rows. Returns false if the static layer has changed; then all rows are set. */
bool damage_find(const Drawing *before, const Drawing *after, int height, bool *changed);
