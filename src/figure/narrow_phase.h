/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The collision that figure 2 shows, and its two halves. */
#pragma once
#include "figure/separating_axes.h"
#include "figure/sketch.h"
#include "render/style.h"

/* A pair in a step, as the narrow phase saw it. */
typedef struct Collision {
    Box boxes[2];
    int bodies[2], bomb, step;
    Manifold manifold;
    AxisOverlap overlaps[SEPARATING_AXES];
    int least; /* of the overlaps; the manifold's normal lies along its axis */
} Collision;

static inline bool is_bomb(const Collision *collision, int i) { return collision->bodies[i] == collision->bomb; }

static inline uint32_t fill_of(const Collision *collision, int i) {
    return is_bomb(collision, i) ? BOMB.fill : BOX_COLOUR;
}

static inline uint32_t ink_of(const Collision *collision, int i) { return is_bomb(collision, i) ? BOMB.line : BOX_INK; }

static inline const char *name_of(const Collision *collision, int i) { return is_bomb(collision, i) ? "bomb" : "box"; }

/* The boxes where they are, so that their overlap shows. */
void put_collision(Sketch *sketch, const View *view, const Collision *collision);

/* The shadows of both boxes on the axes of each, and how far they overlap. Of the view only the window counts. */
void put_overlaps(Sketch *sketch, View view, const Collision *collision);

/* The overlap enlarged: edges, normal and contact points. Of the view only the window counts. */
void put_contact(Sketch *sketch, View view, const Collision *collision);
