/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sparse factorization of blocks against a dense solve. */
#include "random_blocks.h"
#include "owned.h"

static RandomBlocks blocks;

TEST(the_solution_is_that_of_a_dense_solve) {
    const InteriorKernels *kernels[2];
    const int kernel_count = list_kernels(kernels);
    OWN(BlockLu) lu = {0};
    uint32_t seed = 1;
    Vec4 x[NODES_MAX];
    for (int run = 0; run < 64; run++) {
        const bool large = run >= 60; /* too large to be ordered by exact degrees */
        make_blocks(&blocks, &seed, large ? NODES_MAX - run % 10 : 1 + run, large || run % 3 == 0 ? 0.02f : 0.1f);
        assert_true(block_lu_analyse(&lu, blocks.count, blocks.edges, blocks.edge_count));
        for (int k = 0; k < kernel_count; k++) {
            load_blocks(&lu, &blocks, x);
            kernels[k]->factor(&lu);
            kernels[k]->solve(&lu, x);
        }
        solve_dense(&blocks);
        for (int i = 0; i < blocks.count; i++)
            for (int r = 0; r < 3; r++) assert_near(x[lu.position[i]][r], blocks.right[3 * i + r], 1e-14);
    }
}

TEST(kernels_have_the_same_bits) {
    const InteriorKernels *kernels[2];
    if (list_kernels(kernels) < 2) skip();
    OWN(BlockLu) lu = {0};
    uint32_t seed = 5;
    Vec4 scalar[NODES_MAX], wide[NODES_MAX];
    for (int run = 0; run < 40; run++) {
        make_blocks(&blocks, &seed, 20 + run, 0.08f);
        assert_true(block_lu_analyse(&lu, blocks.count, blocks.edges, blocks.edge_count));
        load_blocks(&lu, &blocks, scalar);
        kernels[0]->factor(&lu);
        kernels[0]->solve(&lu, scalar);
        load_blocks(&lu, &blocks, wide);
        kernels[1]->factor(&lu);
        kernels[1]->solve(&lu, wide);
        for (int i = 0; i < blocks.count; i++) assert_memory_equal(&scalar[i], &wide[i], 3 * sizeof(double));
    }
}

/* stiff (n n^T + m m^T) for the two contacts of a face: it resists motion along (0.6, 0.8) and spin. */
static Block3 stiffness_of_face(double stiff) {
    static const double n[3] = {0.6, 0.8, 0.5}, m[3] = {0.6, 0.8, -0.5};
    Block3 block = {0};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) block.column[c][r] = stiff * (n[r] * n[c] + m[r] * m[c]);
    return block;
}

/* A stack of closed contacts: stiffness 1e9 beside masses of 1. A pull on its end moves all links alike, by its size
   over their number; along the faces only the last link moves. The inverse of a pivot would lose these digits. */
TEST(a_stiff_chain_moves_as_one) {
    enum { LINKS = 20 };
    const Block3 face = stiffness_of_face(1e9);
    OWN(BlockLu) lu = {0};
    BlockEdge edges[LINKS - 1];
    Vec4 x[LINKS] = {{0}};
    for (int i = 0; i + 1 < LINKS; i++) edges[i] = (BlockEdge){i, i + 1};
    assert_true(block_lu_analyse(&lu, LINKS, edges, LINKS - 1));
    assert_int_equal(lu.below, LINKS - 1); /* minimum degree: no fill in a chain */
    memset(lu.blocks, 0, (LINKS + 2 * LINKS + 1) * sizeof *lu.blocks);
    for (int i = 0; i < LINKS; i++)
        for (int c = 0; c < 3; c++) lu.blocks[lu.position[i]].column[c][c] = 1;
    for (int i = 0; i + 1 < LINKS; i++)
        for (int c = 0; c < 3; c++) {
            lu.blocks[lu.position[i]].column[c] += face.column[c];
            lu.blocks[lu.position[i + 1]].column[c] += face.column[c];
            lu.blocks[lu.places[i].row_a].column[c] -= face.column[c];
            lu.blocks[lu.places[i].row_b].column[c] -= face.column[c];
        }
    x[lu.position[LINKS - 1]] = (Vec4){0.6 - 3 * 0.8, 0.8 + 3 * 0.6, 0, 0};
    interior_best()->factor(&lu);
    interior_best()->solve(&lu, x);
    for (int i = 0; i < LINKS; i++) {
        const double along = i == LINKS - 1 ? 3 : 0;
        assert_near(x[lu.position[i]][0], 0.6 / LINKS - 0.8 * along, 1e-5);
        assert_near(x[lu.position[i]][1], 0.8 / LINKS + 0.6 * along, 1e-5);
        assert_near(x[lu.position[i]][2], 0, 1e-5);
    }
}

/* Closed contacts next to open ones: stiffnesses from 1 to 1e12 beside masses of 1. Whatever the condition, each row of
   A x = b holds up to the rounding of its terms, which elimination without exchanges multiplies by the growth of the
   factors. An inverse by cofactors loses this. */
TEST(rows_hold_whatever_the_condition) {
    OWN(BlockLu) lu = {0};
    uint32_t seed = 9;
    Vec4 x[NODES_MAX];
    for (int run = 0; run < 200; run++) {
        make_stiff_blocks(&blocks, &seed, 2 + run % 20);
        assert_true(block_lu_analyse(&lu, blocks.count, blocks.edges, blocks.edge_count));
        load_blocks(&lu, &blocks, x);
        interior_best()->factor(&lu);
        interior_best()->solve(&lu, x);
        for (int r = 0; r < 3 * blocks.count; r++) {
            double missing = -blocks.right[r], terms = fabs(blocks.right[r]);
            for (int c = 0; c < 3 * blocks.count; c++) {
                const double term = blocks.dense[r][c] * x[lu.position[c / 3]][c % 3];
                missing += term;
                terms += fabs(term);
            }
            assert_true(fabs(missing) <= 1e-12 * terms);
        }
    }
}

TEST(an_empty_matrix_is_no_error) {
    OWN(BlockLu) lu = {0};
    assert_true(block_lu_analyse(&lu, 0, NULL, 0));
    interior_best()->factor(&lu);
    interior_best()->solve(&lu, NULL);
    assert_true(block_lu_analyse(&lu, 3, NULL, 0));
    assert_int_equal(lu.below, 0);
}

RUN_TESTS(NULL, NULL)
