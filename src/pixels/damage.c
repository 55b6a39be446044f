/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What changes from one drawing to the next. */
#include "base/base.h"
#include "base/numbers.h"
#include "pixels/gl.h"

#include <stdlib.h>
#include <string.h>

/* The rasteriser's own tiles have this side, too (llvmpipe): it works on whole ones. */
enum { TILE = 64 };

static int tiles_of(int pixels) { return (pixels + TILE - 1) / TILE; }

bool damage_init(Damage *damage, int width, int height, Error *error) {
    *damage = (Damage){.width = width, .height = height};
    damage->rows = calloc((size_t)height, sizeof *damage->rows);
    damage->tiles = calloc((size_t)tiles_of(width) * (size_t)tiles_of(height), sizeof *damage->tiles);
    return (damage->rows != NULL && damage->tiles != NULL) || error_memory(error, "render");
}

void damage_free(Damage *damage) {
    free(damage->rows);
    free(damage->tiles);
}

static void mark(Damage *damage, int left, int top, int right, int bottom) {
    left = int_max(left, 0), top = int_max(top, 0);
    right = int_min(right, damage->width), bottom = int_min(bottom, damage->height);
    if (left >= right || top >= bottom) return;
    memset(damage->rows + top, true, (size_t)(bottom - top));
    for (int y = top / TILE; y < tiles_of(bottom); y++)
        memset(damage->tiles + y * tiles_of(damage->width) + left / TILE, true,
               (size_t)(tiles_of(right) - left / TILE));
}

static void mark_shape(Damage *damage, const ShapeInstance *shape) {
    const int32_t *bounds = shape->bounds;
    mark(damage, bounds[0], bounds[1], bounds[2], bounds[3]);
}

static void mark_glyph(Damage *damage, const GlyphInstance *glyph) {
    const int32_t *box = glyph->box;
    mark(damage, box[0], box[1], box[0] + box[2], box[1] + box[3]);
}

/* The n-th shape of one drawing is compared with the n-th of the other, and glyphs likewise. This respects the order
   of painting: a pixel that no differing instance touches is painted by the same instances in the same order. */
bool damage_find(Damage *damage, const Drawing *a, const Drawing *b) {
    /* The static layers, and the bitmaps to which glyphs refer. */
    const bool equal =
        a != NULL && a->rect_count == b->rect_count && a->static_shapes == b->static_shapes &&
        a->bitmap_size == b->bitmap_size &&
        (a->rect_count == 0 || memcmp(a->rects, b->rects, a->rect_count * sizeof *a->rects) == 0) &&
        (a->bitmap_size == 0 || memcmp(a->bitmaps, b->bitmaps, a->bitmap_size) == 0) &&
        (a->static_shapes == 0 || memcmp(a->shapes, b->shapes, a->static_shapes * sizeof *a->shapes) == 0);
    memset(damage->rows, !equal, (size_t)damage->height);
    memset(damage->tiles, !equal, (size_t)tiles_of(damage->width) * (size_t)tiles_of(damage->height));
    if (!equal) return false;
    for (size_t i = a->static_shapes; i < size_max(a->shape_count, b->shape_count); i++) {
        const ShapeInstance *from = i < a->shape_count ? &a->shapes[i] : NULL,
                            *to = i < b->shape_count ? &b->shapes[i] : NULL;
        if (from != NULL && to != NULL && memcmp(from, to, sizeof *from) == 0) continue;
        if (from != NULL) mark_shape(damage, from);
        if (to != NULL) mark_shape(damage, to);
    }
    for (size_t i = 0; i < size_max(a->glyph_count, b->glyph_count); i++) {
        const GlyphInstance *from = i < a->glyph_count ? &a->glyphs[i] : NULL,
                            *to = i < b->glyph_count ? &b->glyphs[i] : NULL;
        if (from != NULL && to != NULL && memcmp(from, to, sizeof *from) == 0) continue;
        if (from != NULL) mark_glyph(damage, from);
        if (to != NULL) mark_glyph(damage, to);
    }
    return true;
}

bool damage_next(const Damage *damage, Rect *part) {
    const int across = tiles_of(damage->width), end = across * tiles_of(damage->height);
    int tile = part->top / TILE * across + tiles_of(part->right);
    while (tile < end && !damage->tiles[tile]) tile++;
    if (tile == end) return false;
    const int top = tile / across * TILE, left = tile % across;
    int right = left;
    while (right < across && damage->tiles[tile++]) right++;
    *part = (Rect){left * TILE, top, int_min(right * TILE, damage->width), int_min(top + TILE, damage->height)};
    return true;
}
