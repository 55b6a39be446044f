/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work that consists of groups of items, such as launches of some scenes: a piece is a range of items of one group. */
#pragma once
#include <stdint.h>

enum { PIECE_RANGES_MAX = 16 };

/* Zero: no group. */
typedef struct PieceRanges {
    int groups;
    int64_t first_piece[PIECE_RANGES_MAX + 1], first_item[PIECE_RANGES_MAX + 1]; /* of each group, then the ends */
} PieceRanges;

/* Adds a group of at least one item, in so many pieces; at least 1 and at most one for each item. */
void piece_ranges_add(PieceRanges *ranges, int64_t items, double pieces);

/* The items of a piece, first to end - 1, numbered through all groups. Returns its group. */
int piece_ranges_find(const PieceRanges *ranges, int64_t piece, int64_t *first, int64_t *end);

static inline int64_t piece_ranges_count(const PieceRanges *ranges) { return ranges->first_piece[ranges->groups]; }
