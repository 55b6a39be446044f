/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The symbolic part: the graph of a contact problem, and the pattern with fill. A row's blocks are the columns on the
   paths from its neighbours towards the root of the elimination tree: each is found once, so the time is that of
   writing the pattern. Source: Liu, "The Role of Elimination Trees in Sparse Factorization" (1990). */
#include "methods/block_lu.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_order.h"

#include <stdlib.h>
#include <string.h>

void block_lu_free(BlockLu *lu) {
    free(lu->graph.memory);
    free(lu->filled.memory);
    free(lu->in_row);
    block_order_free(&lu->choice);
    *lu = (BlockLu){0};
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

static int find_block(const BlockLu *lu, int row, int column) {
    int x = lu->column[column];
    while (lu->row[x] != row) x++;
    return x;
}

bool block_lu_analyse(BlockLu *lu, int count, const BlockEdge *edges, int edge_count) {
    const size_t size = (size_t)edge_count * sizeof *edges;
    if (lu->blocks != NULL && lu->count == count && lu->edge_count == edge_count &&
        (size == 0 || memcmp(lu->edges, edges, size) == 0))
        return true;
    lu->edge_count = -1; /* until the new analysis is complete */
    const size_t nodes = (size_t)count + 2, most = (size_t)edge_count + 1;
    if (!ARRAY_BLOCK_RESERVE(&lu->graph, ARRAY_PART(lu->column, nodes), ARRAY_PART(lu->position, nodes),
                             ARRAY_PART(lu->order, nodes), ARRAY_PART(lu->start, nodes), ARRAY_PART(lu->parent, nodes),
                             ARRAY_PART(lu->find, nodes), ARRAY_PART(lu->mark, nodes), ARRAY_PART(lu->row_start, nodes),
                             ARRAY_PART(lu->neighbour, 2 * most), ARRAY_PART(lu->places, most),
                             ARRAY_PART(lu->edges, most)))
        return false;
    lu->count = count;
    if (size > 0) memcpy(lu->edges, edges, size);
    connect(lu, edge_count);
    const BlockNeighbours neighbours = {count, lu->start, lu->neighbour};
    if (!block_order_choose(&lu->choice, &neighbours, lu->order)) return false;
    for (int k = 0; k < count; k++) lu->position[lu->order[k]] = k;
    if (!walk_rows(lu)) return false;
    const size_t below = (size_t)lu->below, blocks = (size_t)lu->count + 2 * below + 3;
    if (!ARRAY_BLOCK_RESERVE(&lu->filled, ARRAY_PART(lu->blocks, blocks), ARRAY_PART(lu->row, below + 1))) return false;
    list_blocks(lu);
    lu->edge_count = edge_count;
    const int lower = lu->count + 1, upper = lower + lu->below + 1;
    for (int i = 0; i < edge_count; i++) {
        const int a = lu->position[lu->edges[i].a], b = lu->position[lu->edges[i].b];
        const int x = a > b ? find_block(lu, a, b) : find_block(lu, b, a);
        lu->places[i] = a > b ? (BlockPlace){lower + x, upper + x} : (BlockPlace){upper + x, lower + x};
    }
    return true;
}

void block_graph_free(BlockGraph *graph) {
    block_lu_free(&graph->lu);
    free(graph->memory.memory);
    *graph = (BlockGraph){0};
}

bool block_graph_reserve(BlockGraph *graph, int body_count, int pair_count) {
    const size_t bodies = (size_t)body_count + 1, pairs = (size_t)pair_count + 1;
    return ARRAY_BLOCK_RESERVE(&graph->memory, ARRAY_PART(graph->masses, bodies), ARRAY_PART(graph->inverses, bodies),
                               ARRAY_PART(graph->bodies, bodies), ARRAY_PART(graph->nodes, bodies),
                               ARRAY_PART(graph->ends, pairs), ARRAY_PART(graph->edges, pairs),
                               ARRAY_PART(graph->edge_of, pairs));
}

/* A body that can move but has no inverse mass, in a direction, is 1e20 kg or kg m^2 heavy. */
static double mass_of(float inverse) { return inverse > 0 ? 1 / (double)inverse : 1e20; }

bool block_graph_load(BlockGraph *graph, const ContactProblem *problem, int pair_count) {
    /* Nodes: the moving bodies that touch something. */
    int count = 0, edges = 0;
    memset(graph->nodes, 0, (size_t)problem->body_count * sizeof *graph->nodes);
    for (int i = 0; i < pair_count; i++) graph->nodes[graph->ends[i].a] = graph->nodes[graph->ends[i].b] = 1;
    for (int i = 0; i < problem->body_count; i++)
        graph->nodes[i] = graph->nodes[i] && problem_body_moves(&problem->bodies[i]) ? count++ : -1;
    for (int i = 0; i < pair_count; i++) {
        const int a = graph->nodes[graph->ends[i].a], b = graph->nodes[graph->ends[i].b];
        graph->edge_of[i] = a >= 0 && b >= 0 ? edges : -1;
        if (graph->edge_of[i] >= 0) graph->edges[edges++] = (BlockEdge){a, b};
    }
    if (!block_lu_analyse(&graph->lu, count, graph->edges, edges)) return false;
    for (int i = 0; i < problem->body_count; i++) {
        if (graph->nodes[i] < 0) continue;
        const ProblemBody *body = &problem->bodies[i];
        const int k = graph->lu.position[graph->nodes[i]];
        const double mass = mass_of(body->inv_mass), inverse = (double)body->inv_mass;
        graph->bodies[k] = i;
        graph->masses[k] = (Vec4){mass, mass, mass_of(body->inv_inertia), 0};
        graph->inverses[k] = (Vec4){inverse, inverse, (double)body->inv_inertia, 0};
    }
    graph->masses[count] = graph->inverses[count] = (Vec4){0};
    return true;
}

bool block_graph_place(const BlockGraph *graph, int i, BlockPair *pair) {
    const BlockLu *lu = &graph->lu;
    const int32_t spare = block_lu_spare(lu);
    pair->a = block_graph_position(graph, graph->ends[i].a);
    pair->b = block_graph_position(graph, graph->ends[i].b);
    pair->place = graph->edge_of[i] >= 0 ? lu->places[graph->edge_of[i]] : (BlockPlace){spare, spare};
    return pair->a < lu->count || pair->b < lu->count;
}

void block_rows_load(BlockRows *rows, int slot, BlockPair *pair, int k, Vec2 normal, Vec2 arm_a, Vec2 arm_b) {
    const double x = (double)normal.x, y = (double)normal.y, bx = (double)arm_b.x, by = (double)arm_b.y,
                 ax = (double)arm_a.x, ay = (double)arm_a.y;
    const Vec4 along = {x, y, bx * y - by * x, ay * x - ax * y}, across = {y, -x, -(bx * x + by * y), ax * x + ay * y};
    pair->normal[k] = along;
    pair->tangent[k] = across;
    rows->normal_x[slot] = x;
    rows->normal_y[slot] = y;
    rows->normal_b[slot] = along[2];
    rows->normal_a[slot] = along[3];
    rows->tangent_b[slot] = across[2];
    rows->tangent_a[slot] = across[3];
}

Vec4 block_pair_velocity(const ProblemBody *a, const ProblemBody *b) {
    return (Vec4){(double)b->velocity.x - (double)a->velocity.x, (double)b->velocity.y - (double)a->velocity.y,
                  (double)b->angular_velocity, (double)a->angular_velocity};
}
