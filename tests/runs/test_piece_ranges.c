/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every item is in one piece, whose size differs by at most one from others of its group. */
#include "testing.h"

#include "runs/pieces.h"

TEST(items_are_dealt_out_evenly) {
    const struct {
        int items;
        double pieces;
        int expected;
    } groups[] = {{10, 3, 3}, {7, 0, 1}, {5, 90, 5}, {100, 6.2, 7}, {1, 1, 1}};
    enum { GROUPS = sizeof groups / sizeof *groups };
    PieceRanges ranges = {0};
    int64_t pieces = 0, item = 0;
    for (int g = 0; g < GROUPS; g++) {
        piece_ranges_add(&ranges, groups[g].items, groups[g].pieces);
        pieces += groups[g].expected;
        assert_int_equal(piece_ranges_count(&ranges), pieces);
    }
    for (int64_t piece = 0; piece < pieces; piece++) {
        int64_t first, end;
        const int g = piece_ranges_find(&ranges, piece, &first, &end);
        assert_int_equal(first, item);
        assert_in_range(end - first, groups[g].items / groups[g].expected,
                        groups[g].items / groups[g].expected + (groups[g].items % groups[g].expected > 0));
        assert_true(end <= ranges.first_item[g + 1]);
        item = end;
    }
    assert_int_equal(item, ranges.first_item[GROUPS]);
    assert_int_equal(item, 10 + 7 + 5 + 100 + 1);
}

RUN_TESTS(NULL, NULL)
