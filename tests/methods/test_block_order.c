/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of elimination: of graphs whose fill is known in closed form, and of large ones. Both ways to order are met:
   graphs of up to 128 nodes and larger ones. */
#include "owned.h"

#include "methods/block_lu.h"

enum { NODES_MAX = 20000, EDGES_MAX = 3 * NODES_MAX };

static BlockEdge edges[EDGES_MAX];

static BlockLu analysed(int count, int edge_count) {
    BlockLu lu = {0};
    assert_true(block_lu_analyse(&lu, count, edges, edge_count));
    bool seen[NODES_MAX] = {false};
    for (int i = 0; i < count; i++) {
        assert_in_range(lu.position[i], 0, count - 1);
        assert_false(seen[lu.position[i]]);
        seen[lu.position[i]] = true;
    }
    return lu;
}

static int fill_of(int count, int edge_count) {
    OWN(BlockLu) lu = analysed(count, edge_count);
    const int below = lu.below;
    return below - edge_count;
}

/* `trees` random trees of `size` nodes each: leaves can always come before what they hang on. Approximate degrees miss
   a few. */
static int make_trees(int trees, int size) {
    int count = 0;
    for (int tree = 0; tree < trees; tree++)
        for (int i = 1; i < size; i++)
            edges[count++] = (BlockEdge){tree * size + (i * 7919 + tree) % i, tree * size + i};
    return count;
}

TEST(trees_do_not_fill_in) {
    static const int sizes[][2] = {{1, 2}, {1, 128}, {1, 129}, {1, 5000}, {500, 10}, {12, 11}, {3, 400}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int count = sizes[i][0] * sizes[i][1], fill = fill_of(count, make_trees(sizes[i][0], sizes[i][1]));
        assert_true(count <= 128 ? fill == 0 : 1000 * fill <= count);
    }
}

/* The hub of a star must come last, and a chain from its ends or anywhere, not by every second node. */
TEST(stars_and_chains_do_not_fill_in) {
    for (int count = 64; count <= 4096; count *= 4) {
        for (int i = 0; i + 1 < count; i++) edges[i] = (BlockEdge){count - 1, i};
        assert_int_equal(fill_of(count, count - 1), 0);
        for (int i = 0; i + 1 < count; i++) edges[i] = (BlockEdge){i + 1, i};
        assert_int_equal(fill_of(count, count - 1), 0);
    }
}

/* A ring of n nodes needs n - 3 more edges to be chordal, in any order of elimination. */
TEST(rings_fill_in_by_their_chords) {
    for (int count = 4; count <= 4096; count *= 2) {
        for (int i = 0; i < count; i++) edges[i] = (BlockEdge){i, (i + 1) % count};
        assert_int_equal(fill_of(count, count), count - 3);
    }
}

/* Without edges, and with all: nothing can fill in. */
TEST(extremes_do_not_fill_in) {
    for (int count = 100; count <= 300; count += 100) {
        assert_int_equal(fill_of(count, 0), 0);
        int edge_count = 0;
        for (int a = 0; a < count; a++)
            for (int b = 0; b < a; b++) edges[edge_count++] = (BlockEdge){a, b};
        assert_int_equal(fill_of(count, edge_count), 0);
    }
}

/* A wall of side x side nodes with neighbours across and above. */
static int make_wall(int side) {
    int count = 0;
    for (int i = 0; i < side * side; i++) {
        if (i % side + 1 < side) edges[count++] = (BlockEdge){i, i + 1};
        if (i + side < side * side) edges[count++] = (BlockEdge){i, i + side};
    }
    return count;
}

/* Row by row, side^3 blocks; the best orders have about 7.75 side^2 log2(side) (George 1973). */
TEST(walls_fill_in_little) {
    for (int side = 8; side <= 128; side *= 2) {
        OWN(BlockLu) lu = analysed(side * side, make_wall(side));
        int log2_of_side = 0;
        while (1 << log2_of_side < side) log2_of_side++;
        assert_true(lu.below < 8 * side * side * log2_of_side);
    }
}

/* An analysis after others, of any size, is that of a fresh start. */
TEST(earlier_graphs_leave_no_trace) {
    OWN(BlockLu) used = {0};
    for (int side = 14; side >= 2; side -= 4) {
        const int count = side * side, edge_count = make_wall(side);
        assert_true(block_lu_analyse(&used, count, edges, edge_count));
        OWN(BlockLu) fresh = analysed(count, edge_count);
        assert_int_equal(used.below, fresh.below);
        assert_memory_equal(used.position, fresh.position, (size_t)count * sizeof *used.position);
        assert_memory_equal(used.row, fresh.row, (size_t)fresh.below * sizeof *used.row);
    }
}

RUN_TESTS(NULL, NULL)
