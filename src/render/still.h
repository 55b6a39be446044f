/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bodies of one frame on a transparent background, without grid, axes or text: for figures. */
#pragma once
#include "picture/camera.h"
#include "render/render.h"

/* The bodies to draw. */
typedef enum StillParts { STILL_FIXED = 1, STILL_MOVING = 2, STILL_ALL = 3 } StillParts;

typedef struct StillShot {
    const Trajectory *run;
    int frame;
    MethodColour colour; /* of the bodies */
    StillParts parts;
    Camera camera; /* for the whole image */
} StillShot;

typedef struct Still Still;

/* For images of this size, each side 1 .. RENDER_SIDE_MAX pixels. Sets Mesa's environment variables (context.c). */
Still *still_create(int width, int height, Error *error);
void still_destroy(Still *still);

/* Draws into an image of that size, with straight alpha. */
bool still_draw(Still *still, const StillShot *shot, Image *image, Error *error);
