/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of naming that knows bodies. Only naming.c includes this. */
#pragma once
#include "naming/box_model.h"
#include "naming/naming.h"

/* Owners of differing pixels: CHANGE i is OWNER_FIRST + i. */
enum { OWNER_NONE, OWNER_UNKNOWN, OWNER_FIRST };

typedef struct Naming {
    const NamingScene *scene;
    const Image *pictures[2];
    uint8_t *owners; /* [height, width] */
    int32_t *tops;   /* [height, width] what is drawn on top in the expected picture: a body in the order of
                        drawing, or (their number) an outline; -1: nothing */
    FrameChanges *changes;
} Naming;

/* Adds a change. Returns its index, or -1 if there is no room. */
int naming_add(Naming *naming, const Change *change);

/* Gives the unknown pixels of a rectangle, or of a box and `margin` pixels around it within the rectangle, to a change.
   Returns their number. */
int64_t naming_take_rectangle(Naming *naming, ViewRect rect, int change);
int64_t naming_take_box(Naming *naming, ViewRect rect, const BoxModel *box, double margin, int change);

/* Whether the bodies of a panel are known. */
bool naming_knows_bodies(const Naming *naming, int panel);

/* Names the bodies of a panel: those whose states differ, then those whose pixels do. They must be known. */
bool naming_bodies(Naming *naming, int panel, Error *error);
