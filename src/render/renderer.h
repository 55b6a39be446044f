/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the processes of a sequence need of renderer.c. */
#pragma once
#include "picture/picture.h"
#include "render/render.h"

/* renderer_create() for a picture that is planned already, so that not every process has to. */
Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error);

/* Draws into the image that the last call drew into, for moments that follow each other: only rows that differ
   from the one before are drawn and read, and *changed, of one flag a row, tells which. The first call draws all. */
bool renderer_draw_next(Renderer *renderer, Moment moment, Image *image, const bool **changed, Error *error);
