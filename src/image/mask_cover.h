/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Masks that leave nothing to compare. */
#pragma once
#include "image/mask.h"

/* How many pixels of a picture of this size the mask hides at most, or all if it may not fit to it. An upper bound that
   costs no pass over pixels. */
double mask_most_hidden(const Mask *mask, int width, int height);
