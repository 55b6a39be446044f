/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paints drawings with OpenGL and reads the pixels back. */
#pragma once
#include "gl/drawing.h"
#include "gl/gl_functions.h"
#include "image/image.h"

typedef struct Canvas Canvas;

/* Needs a current context then and in every later call. `gl` must outlive the canvas. */
Canvas *canvas_create(const GlFunctions *gl, int width, int height, Error *error);
void canvas_destroy(Canvas *canvas);

/* Paints a drawing over the background into an image of the canvas's size. `changed`, of one flag a row, tells which
   rows to paint: the image holds the others already, and what keeps still, as well as the background, is as in the
   last call. NULL: paint everything. */
bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, const bool *changed, Image *image,
                  Error *error);
