/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paints drawings with OpenGL and reads back the pixels. */
#pragma once
#include "gl/drawing.h"
#include "gl/gl_functions.h"
#include "image/image.h"

typedef struct Canvas Canvas;

/* This and all later calls need a current context. `gl` must outlive the canvas. */
Canvas *canvas_create(const GlFunctions *gl, int width, int height, Error *error);
void canvas_destroy(Canvas *canvas);

/* Paints a drawing over the background into `image`, which has the canvas's size. `changed` has one flag per row and
   selects the rows to paint; the image must hold the others already, and the static layer and the background must be
   those of the last call. NULL: paint everything. */
bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, const bool *changed, Image *image,
                  Error *error);
