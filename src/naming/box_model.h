/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A box as twinbox draws it (shaders/shape.frag): fill, an outline inside the edge, a band along the local top. Edges are
   smoothed over one pixel by the distance of the pixel's centre. Pixels, y down. */
#pragma once
#include <stdbool.h>

enum { BOX_OUTSIDE, BOX_LINE, BOX_FILL, BOX_BAND, BOX_PARTS };

typedef struct BoxModel {
    double x, y;         /* centre */
    double cosine, sine; /* of the angle, counter-clockwise on the screen */
    double half_width, half_height;
    double line;   /* width of the outline; 0: none */
    double band;   /* from the top edge to the band's lower end; 0: none */
    double radius; /* of the corners */
    bool target;   /* a bomb: its middle shows a target, which this model lacks */
} BoxModel;

/* Whether a pixel may show the target: a ring with a bar towards the local top. */
bool box_hides(const BoxModel *box, double x, double y);

/* Signed distance of a point from the edge, negative inside. */
double box_distance(const BoxModel *box, double x, double y);

/* Shares of the parts in the pixel with this centre; they add up to 1. */
void box_shares(const BoxModel *box, double x, double y, double shares[BOX_PARTS]);

/* The bounds of the box and a margin, as left, top, right, bottom. */
void box_bounds(const BoxModel *box, double margin, double bounds[4]);
