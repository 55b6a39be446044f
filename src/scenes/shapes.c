/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows, stacks and pyramids. Every position is computed in float32 from the first one and not from its
   neighbour, so that rounding does not add up. */
#include "base/base.h"
#include "engine/engine.h"
#include "scenes/scenes_internal.h"
#include "scenes/scenes.h"

#include <stddef.h>

static int64_t line_body_count(int count) { return count; }

static Vec2 line_position(Vec2 first, Vec2 spacing, int count, int64_t i) {
    (void)count;
    return vec2(first.x + spacing.x * (float)i, first.y + spacing.y * (float)i);
}

static int64_t pyramid_body_count(int rows) { return (int64_t)rows * (rows + 1) / 2; }

/* Row by row from below, each from left to right; a row has one body less than the row below it and begins half a
   spacing further right. */
static Vec2 pyramid_position(Vec2 first, Vec2 spacing, int rows, int64_t i) {
    int row = 0;
    for (; i >= rows - row; row++) i -= rows - row;
    return vec2(first.x + 0.5f * spacing.x * (float)row + spacing.x * (float)i, first.y + spacing.y * (float)row);
}

static const PatternKind row = {"row", line_body_count, line_position};
static const PatternKind stack = {"stack", line_body_count, line_position};
static const PatternKind pyramid = {"pyramid", pyramid_body_count, pyramid_position};
const PatternKind *const pattern_kinds[] = {&row, &stack, &pyramid, NULL};

int64_t pattern_body_count(const Pattern *pattern) {
    return pattern->kind == NULL ? 1 : pattern->kind->body_count(pattern->count);
}

BodyDef pattern_body(const Pattern *pattern, int64_t i) {
    BodyDef body = pattern->first;
    if (pattern->kind != NULL)
        body.position = pattern->kind->position(body.position, pattern->spacing, pattern->count, i);
    return body;
}
