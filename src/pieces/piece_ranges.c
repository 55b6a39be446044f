/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/piece_ranges.h"

#include <assert.h>
#include <math.h>

void piece_ranges_add(PieceRanges *ranges, int64_t items, double pieces) {
    const double wanted = fmin(fmax(ceil(pieces), 1), (double)items);
    assert(ranges->groups < PIECE_RANGES_MAX && items > 0);
    const int group = ranges->groups++;
    ranges->first_item[group + 1] = ranges->first_item[group] + items;
    ranges->first_piece[group + 1] = ranges->first_piece[group] + (int64_t)wanted;
}

int piece_ranges_find(const PieceRanges *ranges, int64_t piece, int64_t *first, int64_t *end) {
    int group = 0;
    assert(piece >= 0 && piece < piece_ranges_count(ranges));
    while (piece >= ranges->first_piece[group + 1]) group++;
    const int64_t pieces = ranges->first_piece[group + 1] - ranges->first_piece[group];
    const int64_t items = ranges->first_item[group + 1] - ranges->first_item[group];
    const int64_t i = piece - ranges->first_piece[group];
    *first = ranges->first_item[group] + items * i / pieces;
    *end = ranges->first_item[group] + items * (i + 1) / pieces;
    return group;
}
