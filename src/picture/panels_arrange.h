/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The grid of panels in which the scene is largest, and their camera. */
#pragma once
#include "picture/picture.h"

/* Sets the panels, from the look and the title, and the fixed camera; `legend`: its rows. Panels that a long or high scene
   would leave almost empty have its shape. */
void panels_arrange(Picture *picture, int width, int height, int legend);
