/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masks that leave nothing to compare. */
#pragma once
#include "image/mask.h"

/* Whether a mask could hide all pixels of a picture of this size, or not fit to it. An upper bound that costs no pass over
   pixels: false is certain, true is not. */
bool mask_may_cover(const Mask *mask, int width, int height);
