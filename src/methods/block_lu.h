/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse LU factorization of matrices of 3 x 3 blocks, one row and column of blocks per node, with a symmetric pattern:
   the blocks of nodes i and j are present if an edge connects them. Values need not be symmetric.

   block_lu_analyse() chooses the order of elimination (block_order.h) and finds all blocks that fill in. It does nothing
   if the edges are those of the last call. The caller then writes the blocks and calls the factorization and the
   solution, which are compiled for several instruction sets (block_lu_code.h). Pivots are the diagonal blocks in the
   chosen order, without exchanges: for a matrix M + J^T D J with positive masses M they stay well conditioned. A
   singular pivot gives NaN or infinite results. Source: Davis, "Direct Methods for Sparse Linear Systems" (2006). Bits
   depend on the edges and the values, not on earlier calls. That is why the order is not carried from step to step: it
   would save at most the time of an analysis, 5% of a step with five iterations.

   Why not a library: microseconds of an iteration (a factorization with a known pattern and two solutions), and of an
   analysis, on the contact graphs of pyramids whose boxes touch their neighbours (tests/bench/interior, one run). KLU
   and UMFPACK of SuiteSparse solve the same matrix. CHOLMOD, with half the work, only solves its symmetric part.

       boxes      this         KLU            UMFPACK        CHOLMOD        analysis: this  KLU
       10         1.4          3.7            17             3.9            1.0             4.8
       66         12           70             311            61             7.1             37
       496        424          2,330          4,810          2,499          150             327
       5,050      30,300       138,000        131,000        77,200         1,430           3,620

   UMFPACK and CHOLMOD call a BLAS, whose bits depend on the processor, and KLU exchanges rows by their values. */
#pragma once
#include "methods/block_order.h"

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

/* A lower block, in the list of its row, and the end of its column: the blocks between them are below it. */
typedef struct BlockInRow {
    int32_t block, end;
} BlockInRow;

/* Zero-initialise; arrays grow and are reused. Rows and columns are in the order of elimination: `position` of each
   node. */
typedef struct BlockLu {
    int count;          /* nodes */
    int below;          /* blocks below the diagonal, with fill; as many are above it */
    Block3 *blocks;     /* [count + 1] diagonal, [below + 1] lower, [below + 1] upper; the last of each is spare */
    int32_t *column;    /* [count + 1] column k has the lower blocks column[k] to column[k + 1] - 1 */
    int32_t *row;       /* [below] rising in each column; also the column of the mirrored upper block */
    int32_t *row_start; /* [count + 1] row i has the blocks in_row[row_start[i]] to in_row[row_start[i + 1] - 1] */
    BlockInRow *in_row; /* [below] in any order within a row */
    int32_t *find;      /* [count] work space: the block of a row in the present column */
    int32_t *position;  /* [count] of a node, in the order of elimination */
    BlockPlace *places; /* [edge_count] */
    /* of the analysis */
    int edge_count;
    void *memory;     /* of the blocks */
    BlockEdge *edges; /* [edge_count] */
    BlockOrder choice;
    int32_t *order;             /* [count] nodes by position */
    int32_t *start, *neighbour; /* the graph */
    int32_t *parent;            /* [count] the first row below the diagonal of a column, or -1 */
    int32_t *mark;              /* [count] */
    size_t block_capacity, column_capacity, row_capacity, position_capacity, place_capacity, edge_capacity,
        order_capacity, start_capacity, neighbour_capacity, parent_capacity, mark_capacity, row_start_capacity,
        in_row_capacity, find_capacity;
} BlockLu;

void block_lu_free(BlockLu *lu);

/* edges: of different nodes; the same edge may occur several times. Sets `position` and `places`. False when memory is
   short. */
bool block_lu_analyse(BlockLu *lu, int count, const BlockEdge *edges, int edge_count);

static inline Block3 *block_lu_lower(const BlockLu *lu) { return lu->blocks + lu->count + 1; }
static inline Block3 *block_lu_upper(const BlockLu *lu) { return block_lu_lower(lu) + lu->below + 1; }

/* Index of a block that is written but never read: of pairs with a body that does not move. */
static inline int32_t block_lu_spare(const BlockLu *lu) { return lu->count + 1 + lu->below; }
