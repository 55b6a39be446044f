/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A collision of two boxes, and the two halves of its picture. Of a window only its corners count. */
#pragma once
#include "figure/separating_axes.h"
#include "picture/style.h"
#include "sketch/sketch.h"

/* A pair in a step, as the narrow phase saw it. */
typedef struct Collision {
    Box boxes[2];
    int bodies[2], bomb, step;
    Manifold manifold;
    AxisOverlap overlaps[SEPARATING_AXES];
    int least;       /* of the overlaps; the manifold's normal lies along its axis */
    const char *why; /* that one: "the least" */
    char names[2][16];
    double points; /* of type */
    Vec2 normal;   /* the manifold's, as the world has it where the picture is turned */
} Collision;

/* Finds manifold and overlaps of the boxes. False where they touch nowhere. */
bool collision_find(Collision *collision);

/* Turns all about the origin so that the reference box lies below the other. Returns where down is then; unit. */
Vec2 collision_turn_up(Collision *collision);

static inline bool is_bomb(const Collision *collision, int i) { return collision->bodies[i] == collision->bomb; }

/* Two boxes are told apart, too. */
static inline bool is_second_box(const Collision *collision, int i) { return i == 1 && !is_bomb(collision, 0); }

static inline uint32_t fill_of(const Collision *collision, int i) {
    return is_bomb(collision, i) ? BOMB.fill : is_second_box(collision, i) ? NETWORK_COLOUR : BOX_COLOUR;
}

static inline uint32_t ink_of(const Collision *collision, int i) {
    return is_bomb(collision, i) ? BOMB.line : is_second_box(collision, i) ? NETWORK_INK : BOX_INK;
}

static inline const char *name_of(const Collision *collision, int i) { return collision->names[i]; }

/* The boxes where they are, so that their overlap shows. */
void put_collision(Sketch *sketch, const View *view, const Collision *collision);

/* The shadows of both boxes on the axes of each, and how far they overlap, around the middle of the view's window. */
void put_overlaps(Sketch *sketch, View window, const Collision *collision);

/* The overlap enlarged: edges, normal and contact points, around the middle of the view's window. */
void put_contact(Sketch *sketch, View window, const Collision *collision);
