/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of the picture. Nothing here depends on the machine or the hour, only on the trajectories. */
#pragma once
#include "render/picture.h"

/* The scene, and at the right how far apart the panels are, the frame and the simulated time. */
void caption_header(const Picture *picture, int frame, Drawing *drawing);

/* What solved a panel, above it. */
void caption_panel(const Picture *picture, int panel, int frame, Drawing *drawing);
