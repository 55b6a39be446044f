/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The collision of two boxes, and the two halves of its picture. Of a View passed in, only the corners are used. */
#pragma once
#include "figure/separating_axes.h"
#include "picture/style.h"
#include "sketch/sketch.h"

/* A pair in a step, as the narrow phase found it. */
typedef struct Collision {
    Box boxes[2];
    int bodies[2], bomb, step;
    Manifold manifold;
    AxisOverlap overlaps[SEPARATING_AXES];
    int least;         /* index of the overlap whose axis is the manifold's normal */
    const char *label; /* label of that overlap: "smallest overlap" */
    char names[2][16];
    double points; /* font size */
    Vec2 normal;   /* the manifold's, in world coordinates (the picture is rotated) */
} Collision;

/* Computes manifold and overlaps of the boxes. False if they do not touch. */
bool collision_find(Collision *collision);

/* Rotates everything about the origin so that the reference box is below the other. Returns the rotated down
   direction, unit. */
Vec2 collision_turn_up(Collision *collision);

static inline bool is_bomb(const Collision *collision, int i) { return collision->bodies[i] == collision->bomb; }

/* Gives two boxes different colours. */
static inline bool is_second_box(const Collision *collision, int i) { return i == 1 && !is_bomb(collision, 0); }

static inline uint32_t fill_of(const Collision *collision, int i) {
    return is_bomb(collision, i) ? BOMB.fill : is_second_box(collision, i) ? NETWORK_COLOUR : BOX_COLOUR;
}

static inline uint32_t ink_of(const Collision *collision, int i) {
    return is_bomb(collision, i) ? BOMB.line : is_second_box(collision, i) ? NETWORK_INK : BOX_INK;
}

static inline const char *name_of(const Collision *collision, int i) { return collision->names[i]; }

/* Draws both boxes, translucent, so that their overlap is visible. */
void draw_collision_boxes(Sketch *sketch, const View *view, const Collision *collision);

/* Draws the projections of both boxes on the axes of each, and their overlaps, centred in the window. */
void draw_overlaps(Sketch *sketch, View window, const Collision *collision);

/* Draws an enlarged view of the overlap: edges, normal and contact points, centred in the window. */
void draw_contact_closeup(Sketch *sketch, View window, const Collision *collision);
