/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One panel for naming: its bodies as drawn, and what its pixels tell of one of them. Only naming_*.c include this. */
#pragma once
#include "naming/body_fit.h"
#include "naming/naming_bodies.h"

/* A body as drawn in a panel. */
typedef struct Drawn {
    int index;
    bool exists[2];
    BoxModel box[2]; /* expected, actual */
    double moved;    /* pixels, of the corner that the states move farthest; infinite if it exists on one side only */
    int64_t pixels;  /* unknown ones on it */
    bool tried;
} Drawn;

typedef struct Panel {
    Naming *naming;
    int number; /* from 0 */
    const ViewPanel *view;
    const Trajectory *runs[2];
    int count;
    Drawn *bodies; /* [count], in the order of drawing */
    FitPixels *pixels;
} Panel;

/* The order of drawing. */
typedef enum BodyLayer { LAYER_STATIC, LAYER_DYNAMIC, LAYER_BOMB, LAYERS } BodyLayer;
BodyLayer panel_layer(const Trajectory *run, int body);

/* Fills the bodies, and `tops` in the panel. *usable: false if bodies so large and many are no picture of a scene. The
   runs must be known. panel_close() frees the panel, also after an error. */
bool panel_open(Panel *panel, Naming *naming, int number, bool *usable, Error *error);
void panel_close(Panel *panel);

size_t panel_pixel(const Panel *panel, int x, int y);

/* The part of a box's bounds that is in the panel; empty if right <= left. */
ViewRect panel_bounds(const Panel *panel, const BoxModel *box, double margin);

/* The bounds of the panel's unknown pixels; empty if there are none. */
ViewRect panel_unknown(const Panel *panel);

/* Explains the unknown pixels, which are within `changed`, by a change of one body. */
BodyFit panel_fit(Panel *panel, int body, ViewRect changed);
