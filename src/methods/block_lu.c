/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The symbolic part: the pattern with fill. A row's blocks are the columns on the paths from its neighbours
   towards the root of the elimination tree: each is found once, so the time is that of writing the pattern. Source:
   Liu, "The Role of Elimination Trees in Sparse Factorization" (1990). */
#include "methods/block_lu.h"

#include "base/base.h"
#include "methods/block_order.h"

#include <stdlib.h>
#include <string.h>

enum { CACHE_LINE = 64 }; /* bytes */

void block_lu_free(BlockLu *lu) {
    void *arrays[] = {lu->memory, lu->column, lu->row,   lu->row_start, lu->in_row, lu->position, lu->places,
                      lu->edges,  lu->order,  lu->start, lu->neighbour, lu->parent, lu->mark,     lu->find};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    block_order_free(&lu->choice);
    *lu = (BlockLu){0};
}

static bool reserve(BlockLu *lu, int count, int edge_count) {
    const size_t nodes = (size_t)count + 1, edges = (size_t)edge_count + 1, size = sizeof(int32_t);
    return array_reserve((void **)&lu->column, &lu->column_capacity, nodes, size) &&
           array_reserve((void **)&lu->position, &lu->position_capacity, nodes, size) &&
           array_reserve((void **)&lu->order, &lu->order_capacity, nodes, size) &&
           array_reserve((void **)&lu->start, &lu->start_capacity, nodes + 1, size) &&
           array_reserve((void **)&lu->parent, &lu->parent_capacity, nodes, size) &&
           array_reserve((void **)&lu->find, &lu->find_capacity, nodes, size) &&
           array_reserve((void **)&lu->mark, &lu->mark_capacity, nodes, size) &&
           array_reserve((void **)&lu->row_start, &lu->row_start_capacity, nodes, size) &&
           array_reserve((void **)&lu->neighbour, &lu->neighbour_capacity, 2 * edges, size) &&
           array_reserve((void **)&lu->places, &lu->place_capacity, edges, sizeof *lu->places) &&
           array_reserve((void **)&lu->edges, &lu->edge_capacity, edges, sizeof *lu->edges);
}

/* Lists of neighbours, without the repeated ones. */
static void connect(BlockLu *lu, int edge_count) {
    int32_t *start = lu->start;
    memset(start, 0, ((size_t)lu->count + 2) * sizeof *start);
    for (int i = 0; i < edge_count; i++) {
        start[lu->edges[i].a + 2]++;
        start[lu->edges[i].b + 2]++;
    }
    for (int i = 0; i < lu->count; i++) start[i + 2] += start[i + 1];
    for (int i = 0; i < edge_count; i++) {
        lu->neighbour[start[lu->edges[i].a + 1]++] = lu->edges[i].b;
        lu->neighbour[start[lu->edges[i].b + 1]++] = lu->edges[i].a;
    }
    for (int i = 0; i < lu->count; i++) lu->mark[i] = -1;
    int kept = 0;
    for (int i = 0, from = 0; i < lu->count; i++) {
        const int to = start[i + 1];
        start[i] = kept;
        for (int x = from; x < to; x++) {
            if (lu->mark[lu->neighbour[x]] == i) continue;
            lu->mark[lu->neighbour[x]] = i;
            lu->neighbour[kept++] = lu->neighbour[x];
        }
        from = to;
    }
    start[lu->count] = kept;
}

/* Finds the elimination tree and the columns of each row's blocks, which in_row holds for now, and counts the blocks of
   each column. */
static bool walk_rows(BlockLu *lu) {
    int32_t *const mark = lu->mark, *const parent = lu->parent, *const column = lu->column;
    memset(column, 0, ((size_t)lu->count + 1) * sizeof *column);
    lu->below = lu->row_start[0] = 0;
    for (int i = 0; i < lu->count; i++) {
        if (!array_reserve((void **)&lu->in_row, &lu->in_row_capacity, (size_t)lu->below + (size_t)i + 1,
                           sizeof *lu->in_row))
            return false;
        BlockInRow *block = lu->in_row + lu->below;
        const int node = lu->order[i];
        mark[i] = i;
        parent[i] = -1;
        for (int x = lu->start[node]; x < lu->start[node + 1]; x++)
            for (int k = lu->position[lu->neighbour[x]]; k < i && mark[k] != i; k = parent[k]) {
                mark[k] = i;
                if (parent[k] < 0) parent[k] = i;
                column[k + 1]++;
                (block++)->block = k;
            }
        lu->row_start[i + 1] = lu->below = (int)(block - lu->in_row);
    }
    for (int i = 0; i < lu->count; i++) column[i + 1] += column[i];
    return true;
}

/* Rows rise in each column, as they are listed in this order. */
static void list_blocks(BlockLu *lu) {
    int32_t *const next = lu->find, *const row = lu->row;
    const int32_t *const column = lu->column;
    BlockInRow *block = lu->in_row;
    memcpy(next, column, (size_t)lu->count * sizeof *next);
    for (int i = 0; i < lu->count; i++)
        for (const BlockInRow *end = lu->in_row + lu->row_start[i + 1]; block < end; block++) {
            const int k = block->block, x = next[k]++;
            row[x] = i;
            *block = (BlockInRow){x, column[k + 1]};
        }
}

/* Blocks are read in vectors of 32 bytes; those that cross a cache line cost twice. */
static bool reserve_blocks(BlockLu *lu) {
    const size_t blocks = (size_t)lu->count + 2 * (size_t)lu->below + 3;
    if (!array_reserve((void **)&lu->row, &lu->row_capacity, (size_t)lu->below + 1, sizeof *lu->row) ||
        !array_reserve(&lu->memory, &lu->block_capacity, blocks + 1, sizeof *lu->blocks))
        return false;
    const size_t beyond = (uintptr_t)lu->memory % CACHE_LINE;
    lu->blocks = (Block3 *)((char *)lu->memory + (beyond > 0 ? CACHE_LINE - beyond : 0));
    return true;
}

static int find_block(const BlockLu *lu, int row, int column) {
    int x = lu->column[column];
    while (lu->row[x] != row) x++;
    return x;
}

static void place_edges(BlockLu *lu) {
    const int lower = lu->count + 1, upper = lower + lu->below + 1;
    for (int i = 0; i < lu->edge_count; i++) {
        const int a = lu->position[lu->edges[i].a], b = lu->position[lu->edges[i].b];
        const int x = a > b ? find_block(lu, a, b) : find_block(lu, b, a);
        lu->places[i] = a > b ? (BlockPlace){lower + x, upper + x} : (BlockPlace){upper + x, lower + x};
    }
}

bool block_lu_analyse(BlockLu *lu, int count, const BlockEdge *edges, int edge_count) {
    const size_t size = (size_t)edge_count * sizeof *edges;
    if (lu->blocks != NULL && lu->count == count && lu->edge_count == edge_count &&
        (size == 0 || memcmp(lu->edges, edges, size) == 0))
        return true;
    lu->edge_count = -1; /* until the new analysis is complete */
    if (!reserve(lu, count, edge_count)) return false;
    lu->count = count;
    if (size > 0) memcpy(lu->edges, edges, size);
    connect(lu, edge_count);
    const BlockGraph graph = {count, lu->start, lu->neighbour};
    if (!block_order_choose(&lu->choice, &graph, lu->order)) return false;
    for (int k = 0; k < count; k++) lu->position[lu->order[k]] = k;
    if (!walk_rows(lu) || !reserve_blocks(lu)) return false;
    list_blocks(lu);
    lu->edge_count = edge_count;
    place_edges(lu);
    return true;
}
