/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One entry of a scene's bodies: a single body, or a pattern of equal bodies. */
#pragma once
#include "dynamics/body.h"

#include <stdint.h>

/* A kind of pattern. */
typedef struct PatternKind {
    const char *name;
    int64_t (*body_count)(int count);
    Vec2 (*position)(Vec2 first, Vec2 spacing, int count, int64_t i); /* of body i */
} PatternKind;

typedef struct Pattern {
    const PatternKind *kind; /* NULL: one body */
    int count;               /* bodies of a row or a stack, rows of a pyramid */
    Vec2 spacing;            /* m */
    int until;               /* the step after which a single body is removed; 0: never */
    BodyDef first;           /* the first body; the others differ from it by their position only */
} Pattern;

/* Ended by NULL. */
extern const PatternKind *const pattern_kinds[];

int64_t pattern_body_count(const Pattern *pattern);

BodyDef pattern_body(const Pattern *pattern, int64_t i);
