/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies of one frame without anything around them, on nothing: for figures, which bring their own words. */
#pragma once
#include "picture/camera.h"
#include "render/render.h"

/* What of a frame is drawn. */
typedef enum StillParts { STILL_FIXED = 1, STILL_MOVING = 2, STILL_ALL = 3 } StillParts;

typedef struct StillShot {
    const Trajectory *run;
    int frame, colours; /* colours: those of the panel of this number, 0 .. RENDER_PANELS_MAX - 1 */
    StillParts parts;
    Camera camera; /* of the whole image */
} StillShot;

typedef struct Still Still;

/* For images of this size, each side 1 .. RENDER_SIDE_MAX pixels. Sets Mesa's environment variables (context.c). */
Still *still_create(int width, int height, Error *error);
void still_destroy(Still *still);

/* Draws into an image of that size; its alpha tells how much of a pixel bodies cover. */
bool still_draw(Still *still, const StillShot *shot, Image *image, Error *error);
