/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "collision/broad_phase.h"

#include "common/array.h"

#include <float.h>

Bounds bounds_of_box(const Box *box) {
    Vec2 reach = mat22_multiply(mat22_abs(box->rotation), box->half);
    /* Eight roundings of numbers that do not exceed |position| + half extent. */
    float size = fabsf(box->position.x) + fabsf(box->position.y) + reach.x + reach.y;
    float slack = 8.0f * FLT_EPSILON * size;
    Vec2 wide = vec2(reach.x + slack, reach.y + slack);
    return (Bounds){vec2_sub(box->position, wide), vec2_add(box->position, wide)};
}

bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count) {
    list->count = 0;
    for (int a = 0; a < count; a++) {
        for (int b = a + 1; b < count; b++) {
            if (!bounds_overlap(&bounds[a], &bounds[b]) || (fixed[a] && fixed[b])) continue;
            if (!array_reserve((void **)&list->pairs, &list->capacity, list->count + 1, sizeof *list->pairs))
                return false;
            list->pairs[list->count++] = (BodyPair){a, b};
        }
    }
    return true;
}
