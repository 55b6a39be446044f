/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names what differs between two of twinbox's own pictures: bodies, captions, axes. */
#pragma once
#include "image/image.h"
#include "naming/change.h"
#include "naming/view.h"

enum { NAMING_PIXELS_MAX = 20000000 }; /* larger pictures get no names of bodies */

/* What both pictures show. */
typedef struct NamingScene {
    const View *view;                           /* of both pictures */
    const Trajectory *runs[VIEW_PANELS_MAX][2]; /* per panel: expected, actual; NULL: unknown; may be the same */
    const Trajectory
        *outlines[VIEW_PANELS_MAX][VIEW_PANELS_MAX]; /* per panel: expected runs drawn as outlines, or NULL */
    int frame;                                       /* of the runs */
} NamingScene;

/* Fills the changes, and the names of the regions, which must be set. masked as in image_compare_masked(). Both pictures
   have the view's size. False with error set if out of memory. */
bool naming_find(const NamingScene *scene, const Image *expected, const Image *actual, const uint8_t *masked,
                 FrameChanges *changes, Error *error);
