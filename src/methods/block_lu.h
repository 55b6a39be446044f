/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse LU factorization of matrices of 3 x 3 blocks, one row and column of blocks per node, with a symmetric
   pattern: the blocks of nodes i and j are present if an edge connects them. Values need not be symmetric.

   block_lu_analyse() chooses the order of elimination (block_order.h) and finds all blocks that fill in. It does
   nothing if the edges are those of the last call. The caller then writes the blocks and calls the factorization and
   the solution, which are compiled for several instruction sets (block_lu_code.h). A BlockGraph does this for the
   bodies of a contact problem. Pivots are the diagonal blocks in the chosen order, without exchanges: for a matrix M
   + J^T D J with positive masses M they stay well conditioned. A singular pivot gives NaN or infinite results.
   Source: Davis, "Direct Methods for Sparse Linear Systems" (2006). Bits depend on the edges and the values, not on
   earlier calls: so the order is not carried from step to step.

   Why not a library: of SuiteSparse, KLU exchanges rows by their values, and UMFPACK and CHOLMOD call a BLAS, whose
   bits depend on the processor. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
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
    BlockEdge *edges; /* [edge_count] */
    BlockOrder choice;
    int32_t *order;             /* [count] nodes by position */
    int32_t *start, *neighbour; /* the neighbours of each node */
    int32_t *parent;            /* [count] the first row below the diagonal of a column, or -1 */
    int32_t *mark;              /* [count] */
    ArrayBlock graph, filled;   /* memory: of the arrays by nodes and edges; of blocks and row */
    size_t in_row_capacity;
} BlockLu;

void block_lu_free(BlockLu *lu);

/* edges: of different nodes; the same edge may occur several times. Sets `position` and `places`. False when memory is
   short. */
bool block_lu_analyse(BlockLu *lu, int count, const BlockEdge *edges, int edge_count);

static inline Block3 *block_lu_lower(const BlockLu *lu) { return lu->blocks + lu->count + 1; }
static inline Block3 *block_lu_upper(const BlockLu *lu) { return block_lu_lower(lu) + lu->below + 1; }

/* Index of a block that is written but never read: of pairs with a body that does not move. */
static inline int32_t block_lu_spare(const BlockLu *lu) { return lu->count + 1 + lu->below; }

/* The contact graph of a problem, and the rows of its contacts. Nodes are the moving bodies that touch something, in
   the order of the bodies; an edge is a pair of two of them. */

enum { BLOCK_SLOTS = 4, BLOCK_PAIRS = 2 }; /* contacts that are computed together: two of each of two pairs */

/* The rows of the slots. The tangent is (normal_y, -normal_x); the others are those of the spins of b and a, m. */
typedef struct BlockRows {
    Vec4 normal_x, normal_y, normal_b, normal_a, tangent_b, tangent_a;
} BlockRows;

/* A pair's rows in the coordinates (linear velocity of b minus that of a, spin of b, spin of a). */
typedef struct BlockPair {
    Vec4 normal[2], tangent[2];
    int32_t a, b; /* positions of the bodies, also of their diagonal blocks; `count` for a body that does not move */
    BlockPlace place; /* of the blocks that couple them */
} BlockPair;

/* Zero-initialise; arrays grow and are reused. */
typedef struct BlockGraph {
    BlockLu lu;
    Vec4 *masses,
        *inverses;    /* [lu.count + 1] by position; the last is zero, for bodies that do not move. x, y, spin, 0 */
    int32_t *bodies;  /* [lu.count] by position */
    int32_t *nodes;   /* [body_count] -1 for bodies without contact, or that do not move */
    BlockEdge *ends;  /* [pair_count] bodies */
    BlockEdge *edges; /* [lu.edge_count] */
    int32_t *edge_of; /* [pair_count] -1 for a pair with a body that does not move */
    ArrayBlock memory;
} BlockGraph;

void block_graph_free(BlockGraph *graph);

/* Makes room for a problem; the caller then fills `ends`. False when memory is short. */
bool block_graph_reserve(BlockGraph *graph, int body_count, int pair_count);

/* Analyses the graph of these pairs, and loads the masses. False when memory is short. */
bool block_graph_load(BlockGraph *graph, const ContactProblem *problem, int pair_count);

/* Where a body is in the elimination. */
static inline int32_t block_graph_position(const BlockGraph *graph, int body) {
    return graph->nodes[body] >= 0 ? graph->lu.position[graph->nodes[body]] : graph->lu.count;
}

/* Sets a, b and place of pair i. False if an impulse of the pair changes nothing. */
bool block_graph_place(const BlockGraph *graph, int i, BlockPair *pair);

/* The rows of contact k of a pair, which is in that slot. */
void block_rows_load(BlockRows *rows, int slot, BlockPair *pair, int k, Vec2 normal, Vec2 arm_a, Vec2 arm_b);

/* m/s, rad/s: the velocities of two bodies before any impulse, in the coordinates of a pair. */
Vec4 block_pair_velocity(const ProblemBody *a, const ProblemBody *b);
