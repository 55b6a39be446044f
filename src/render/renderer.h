/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of renderer.c that the workers of a sequence use. */
#pragma once
#include "picture/picture.h"
#include "render/render.h"

/* Like renderer_create(), for a picture that is already planned. */
Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error);

/* Draws the next moment of a sequence into the image of the previous call. Only rows that differ are painted and
   read back; *changed has a flag per row. The first call draws all. */
bool renderer_draw_next(Renderer *renderer, Moment moment, Image *image, const bool **changed, Error *error);
