/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "methods/block_order.h"

#include "base/base.h"

#include <amd.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 64, EXACT_MAX = 128 }; /* EXACT_MAX: nodes that are ordered by exact degrees */

void block_order_free(BlockOrder *order) {
    free(order->words);
    free(order->numbers);
    *order = (BlockOrder){0};
}

static void set_bit(uint64_t *row, int bit) { row[bit / WORD] |= (uint64_t)1 << (bit % WORD); }
static void clear_bit(uint64_t *row, int bit) { row[bit / WORD] &= ~((uint64_t)1 << (bit % WORD)); }

/* Inline: not every CPU has an instruction for it, and a call of the compiler's library takes longer. */
static int bits_in(uint64_t word) {
    word -= word >> 1 & UINT64_C(0x5555555555555555);
    word = (word & UINT64_C(0x3333333333333333)) + (word >> 2 & UINT64_C(0x3333333333333333));
    word = (word + (word >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (int)(word * UINT64_C(0x0101010101010101) >> 56);
}

static int bits_of(const uint64_t *row, size_t words) {
    int bits = 0;
    for (size_t w = 0; w < words; w++) bits += bits_in(row[w]);
    return bits;
}

/* The nodes that are left: a row of bits per node, for its neighbours, and one per degree, for the nodes that have it. */
typedef struct Rows {
    int count, lowest;           /* no degree is below `lowest` */
    size_t words;                /* of a row */
    uint64_t *adjacent, *having; /* [count, words] */
    int degree[EXACT_MAX];
} Rows;

static bool load_rows(BlockOrder *order, const BlockNeighbours *graph, Rows *rows) {
    const size_t count = (size_t)graph->count, words = (count + WORD - 1) / WORD, size = count * words;
    if (!array_reserve((void **)&order->words, &order->word_capacity, 2 * size + 1, sizeof *order->words)) return false;
    memset(order->words, 0, 2 * size * sizeof *order->words);
    rows->count = rows->lowest = graph->count;
    rows->words = words;
    rows->adjacent = order->words;
    rows->having = order->words + size;
    for (int i = 0; i < graph->count; i++) {
        const int from = graph->start[i], to = graph->start[i + 1];
        for (int x = from; x < to; x++) set_bit(rows->adjacent + (size_t)i * words, graph->neighbour[x]);
        set_bit(rows->having + (size_t)(to - from) * words, i);
        rows->degree[i] = to - from;
        if (to - from < rows->lowest) rows->lowest = to - from;
    }
    return true;
}

/* The node of the smallest degree; the first of several. */
static int take_node(Rows *rows) {
    for (;; rows->lowest++) {
        uint64_t *having = rows->having + (size_t)rows->lowest * rows->words;
        for (size_t w = 0; w < rows->words; w++)
            if (having[w] != 0) {
                const int node = (int)w * WORD + __builtin_ctzll(having[w]);
                having[w] &= having[w] - 1;
                return node;
            }
    }
}

/* Joins the neighbours of the node with each other. */
static void eliminate(Rows *rows, int node) {
    const size_t words = rows->words;
    const uint64_t *mine = rows->adjacent + (size_t)node * words;
    for (size_t w = 0; w < words; w++)
        for (uint64_t bits = mine[w]; bits != 0; bits &= bits - 1) {
            const int other = (int)w * WORD + __builtin_ctzll(bits);
            uint64_t *row = rows->adjacent + (size_t)other * words;
            for (size_t x = 0; x < words; x++) row[x] |= mine[x];
            clear_bit(row, other);
            clear_bit(row, node);
            clear_bit(rows->having + (size_t)rows->degree[other] * words, other);
            const int degree = rows->degree[other] = bits_of(row, words);
            set_bit(rows->having + (size_t)degree * words, other);
            if (degree < rows->lowest) rows->lowest = degree;
        }
}

static bool by_exact_degrees(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    Rows rows;
    if (!load_rows(order, graph, &rows)) return false;
    for (int k = 0; k < graph->count; k++) {
        nodes[k] = take_node(&rows);
        eliminate(&rows, nodes[k]);
    }
    return true;
}

/* amd_2() and not amd_order(), which allocates. */
static bool by_approximate_degrees(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    enum { ARRAYS = 8 };
    const int count = graph->count, used = graph->start[count], lists = used + used / 5 + count; /* AMD wants room */
    if (!array_reserve((void **)&order->numbers, &order->number_capacity, ARRAYS * (size_t)count + (size_t)lists + 1,
                       sizeof *order->numbers))
        return false;
    int *arrays[ARRAYS], *list = order->numbers + ARRAYS * (size_t)count;
    for (int i = 0; i < ARRAYS; i++) arrays[i] = order->numbers + (size_t)i * (size_t)count;
    int *start = arrays[0], *length = arrays[1];
    for (int i = 0; i < count; i++) {
        start[i] = graph->start[i];
        length[i] = graph->start[i + 1] - graph->start[i];
    }
    memcpy(list, graph->neighbour, (size_t)used * sizeof *list);
    amd_2(count, start, list, length, lists, used, arrays[2], arrays[3], nodes, arrays[4], arrays[5], arrays[6],
          arrays[7], NULL, NULL);
    return true;
}

bool block_order_choose(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    return graph->count <= EXACT_MAX ? by_exact_degrees(order, graph, nodes)
                                     : by_approximate_degrees(order, graph, nodes);
}
