/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the processes of a sequence need of renderer.c. */
#pragma once
#include "render/picture.h"
#include "render/render.h"

/* renderer_create() for a picture that is planned already, so that not every process has to. */
Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error);
