/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The n-th shape of one drawing is compared with the n-th of the other, and glyphs likewise. This respects the order
   of painting: a row that no differing instance touches is painted by the same instances in the same order. */
#include "gl/damage.h"

#include <string.h>

typedef struct Rows {
    bool *changed;
    int height;
} Rows;

/* The static layers, and the bitmaps to which glyphs refer. */
static bool bases_equal(const Drawing *a, const Drawing *b) {
    return a->rect_count == b->rect_count && a->static_shapes == b->static_shapes &&
           (a->rect_count == 0 || memcmp(a->rects, b->rects, a->rect_count * sizeof *a->rects) == 0) &&
           a->bitmap_size == b->bitmap_size &&
           (a->bitmap_size == 0 || memcmp(a->bitmaps, b->bitmaps, a->bitmap_size) == 0) &&
           (a->static_shapes == 0 || memcmp(a->shapes, b->shapes, a->static_shapes * sizeof *a->shapes) == 0);
}

static void mark(const Rows *rows, int top, int bottom) {
    for (int y = top < 0 ? 0 : top; y < bottom && y < rows->height; y++) rows->changed[y] = true;
}

static void mark_shape(const Rows *rows, const Drawing *drawing, size_t i) {
    if (i < drawing->shape_count) mark(rows, drawing->shapes[i].bounds[1], drawing->shapes[i].bounds[3]);
}

static void mark_glyph(const Rows *rows, const Drawing *drawing, size_t i) {
    if (i >= drawing->glyph_count) return;
    const int32_t *box = drawing->glyphs[i].box;
    mark(rows, box[1], box[1] + box[3]);
}

static size_t larger(size_t a, size_t b) { return a > b ? a : b; }

static void mark_shapes(const Rows *rows, const Drawing *before, const Drawing *after) {
    for (size_t i = after->static_shapes; i < larger(before->shape_count, after->shape_count); i++) {
        if (i < before->shape_count && i < after->shape_count &&
            memcmp(&before->shapes[i], &after->shapes[i], sizeof *after->shapes) == 0)
            continue;
        mark_shape(rows, before, i);
        mark_shape(rows, after, i);
    }
}

static void mark_glyphs(const Rows *rows, const Drawing *before, const Drawing *after) {
    for (size_t i = 0; i < larger(before->glyph_count, after->glyph_count); i++) {
        if (i < before->glyph_count && i < after->glyph_count &&
            memcmp(&before->glyphs[i], &after->glyphs[i], sizeof *after->glyphs) == 0)
            continue;
        mark_glyph(rows, before, i);
        mark_glyph(rows, after, i);
    }
}

bool damage_find(const Drawing *before, const Drawing *after, int height, bool *changed) {
    const Rows rows = {changed, height};
    bool equal = bases_equal(before, after);
    memset(changed, !equal, (size_t)height);
    if (!equal) return false;
    mark_shapes(&rows, before, after);
    mark_glyphs(&rows, before, after);
    return true;
}
