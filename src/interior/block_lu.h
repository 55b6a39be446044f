/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse LU factorization of matrices of 3 x 3 blocks, one row and column of blocks per node, with a symmetric pattern:
   the blocks of nodes i and j are present if an edge connects them. Values need not be symmetric.

   block_lu_analyse() chooses the order of elimination by minimum degree and finds all blocks that fill in. It does
   nothing if the edges are those of the last call. The caller then writes the blocks and calls the factorization and
   the solution, which are compiled for several instruction sets (block_lu_code.h). Pivots are the diagonal blocks in the
   chosen order, without exchanges: for a matrix M + J^T D J with positive masses M they stay well conditioned. A
   singular pivot gives NaN or infinite results. Source: George, Liu, "The Evolution of the Minimum Degree Ordering
   Algorithm" (1989); Davis, "Direct Methods for Sparse Linear Systems" (2006). Bits depend on the edges and the values,
   not on earlier calls. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Four numbers that are computed together. Malloc'ed arrays are aligned to 16 bytes only. */
typedef double Vec4 __attribute__((vector_size(32), aligned(16), may_alias));

/* A 3 x 3 block by columns; the fourth number of a column is unused and may be anything. */
typedef struct Block3 {
    Vec4 column[3];
} Block3;

/* The nodes of an edge, in the caller's numbers. */
typedef struct BlockEdge {
    int32_t a, b;
} BlockEdge;

/* Where an edge's blocks are, as indices of `blocks`. */
typedef struct BlockPlace {
    int32_t row_a, row_b; /* the block of row a and column b, and of row b and column a */
} BlockPlace;

/* Eliminates one block below the diagonal and its mirror image above:
   lower[target] -= lower[left] upper[right] and upper[target] -= lower[right] upper[left]. */
typedef struct BlockUpdate {
    int32_t target, left, right;
} BlockUpdate;

/* Zero-initialise; arrays grow and are reused. Rows and columns are in the order of elimination: `position` of each
   node. */
typedef struct BlockLu {
    int count;       /* nodes */
    int below;       /* blocks below the diagonal, with fill; as many are above it */
    Block3 *blocks;  /* [count + 1] diagonal, [below + 1] lower, [below + 1] upper; the last of each is spare */
    int32_t *column; /* [count + 1] column k has the lower blocks column[k] to column[k + 1] - 1 */
    int32_t *row;    /* [below] rising in each column; also the column of the mirrored upper block */
    int32_t *update; /* [count + 1] the updates by column k begin at update[k] */
    BlockUpdate *updates;
    int32_t *position;  /* [count] of a node, in the order of elimination */
    BlockPlace *places; /* [edge_count] */
    /* of the analysis */
    int edge_count;
    BlockEdge *edges;               /* [edge_count] */
    uint64_t *adjacent;             /* [count, words] one bit per node */
    int32_t *order, *degree;        /* [count] */
    int32_t *first, *cursor, *find; /* [count] */
    int32_t *next, *owner;          /* [below] */
    size_t block_capacity, column_capacity, row_capacity, update_capacity, updates_capacity, position_capacity,
        place_capacity, edge_capacity, adjacent_capacity, order_capacity, degree_capacity, first_capacity,
        cursor_capacity, find_capacity, next_capacity, owner_capacity;
} BlockLu;

void block_lu_free(BlockLu *lu);

/* edges: of different nodes; the same edge may occur several times. Sets `position` and `places`. False when memory is
   short. */
bool block_lu_analyse(BlockLu *lu, int count, const BlockEdge *edges, int edge_count);

static inline Block3 *block_lu_lower(const BlockLu *lu) { return lu->blocks + lu->count + 1; }
static inline Block3 *block_lu_upper(const BlockLu *lu) { return block_lu_lower(lu) + lu->below + 1; }

/* Index of a block that is written but never read: of pairs with a body that does not move. */
static inline int32_t block_lu_spare(const BlockLu *lu) { return lu->count + 1 + lu->below; }
