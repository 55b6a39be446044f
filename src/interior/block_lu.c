/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The symbolic part: order of elimination, pattern with fill, list of updates. The graph is kept as rows of bits:
   eliminating a node joins its neighbours by a few words each. */
#include "interior/block_lu.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>

enum { WORD = 64 };

void block_lu_free(BlockLu *lu) {
    void *arrays[] = {lu->blocks, lu->column, lu->row,      lu->update, lu->updates, lu->position,
                      lu->places, lu->edges,  lu->adjacent, lu->order,  lu->degree,  lu->first,
                      lu->cursor, lu->find,   lu->next,     lu->owner};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    *lu = (BlockLu){0};
}

static size_t words_of(int count) { return ((size_t)count + WORD - 1) / WORD; }

static bool reserve_nodes(BlockLu *lu, int count, int edge_count) {
    const size_t nodes = (size_t)count + 1, edges = (size_t)edge_count + 1, size = sizeof(int32_t);
    return array_reserve((void **)&lu->column, &lu->column_capacity, nodes, size) &&
           array_reserve((void **)&lu->update, &lu->update_capacity, nodes, size) &&
           array_reserve((void **)&lu->position, &lu->position_capacity, nodes, size) &&
           array_reserve((void **)&lu->order, &lu->order_capacity, nodes, size) &&
           array_reserve((void **)&lu->degree, &lu->degree_capacity, nodes, size) &&
           array_reserve((void **)&lu->first, &lu->first_capacity, nodes, size) &&
           array_reserve((void **)&lu->cursor, &lu->cursor_capacity, nodes, size) &&
           array_reserve((void **)&lu->find, &lu->find_capacity, nodes, size) &&
           array_reserve((void **)&lu->adjacent, &lu->adjacent_capacity, nodes * (words_of(count) + 1),
                         sizeof *lu->adjacent) &&
           array_reserve((void **)&lu->places, &lu->place_capacity, edges, sizeof *lu->places) &&
           array_reserve((void **)&lu->edges, &lu->edge_capacity, edges, sizeof *lu->edges);
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

static void connect(BlockLu *lu, size_t words) {
    memset(lu->adjacent, 0, (size_t)lu->count * words * sizeof *lu->adjacent);
    for (int i = 0; i < lu->edge_count; i++) {
        const BlockEdge edge = lu->edges[i];
        set_bit(lu->adjacent + (size_t)edge.a * words, edge.b);
        set_bit(lu->adjacent + (size_t)edge.b * words, edge.a);
    }
    for (int i = 0; i < lu->count; i++) lu->degree[i] = bits_of(lu->adjacent + (size_t)i * words, words);
}

/* The node of the smallest degree that is left; the first of several. Eliminated nodes have the degree INT32_MAX. */
static int choose_node(const BlockLu *lu) {
    int best = 0;
    for (int i = 1; i < lu->count; i++)
        if (lu->degree[i] < lu->degree[best]) best = i;
    return best;
}

/* Appends the node's neighbours as a column (nodes, not yet positions), and joins them with each other. */
static bool eliminate(BlockLu *lu, int node, size_t words) {
    const uint64_t *mine = lu->adjacent + (size_t)node * words;
    const size_t wanted = (size_t)lu->below + (size_t)lu->degree[node] + 1;
    if (!array_reserve((void **)&lu->row, &lu->row_capacity, wanted, sizeof *lu->row)) return false;
    for (size_t w = 0; w < words; w++)
        for (uint64_t bits = mine[w]; bits != 0; bits &= bits - 1) {
            const int other = (int)w * WORD + __builtin_ctzll(bits);
            uint64_t *row = lu->adjacent + (size_t)other * words;
            for (size_t x = 0; x < words; x++) row[x] |= mine[x];
            clear_bit(row, other);
            clear_bit(row, node);
            lu->degree[other] = bits_of(row, words);
            lu->row[lu->below++] = other;
        }
    lu->degree[node] = INT32_MAX;
    return true;
}

static bool choose_order(BlockLu *lu) {
    const size_t words = words_of(lu->count);
    connect(lu, words);
    lu->below = 0;
    for (int k = 0; k < lu->count; k++) {
        const int node = choose_node(lu);
        lu->order[k] = node;
        lu->position[node] = k;
        lu->column[k] = lu->below;
        if (!eliminate(lu, node, words)) return false;
    }
    lu->column[lu->count] = lu->below;
    return true;
}

/* Rows by position, rising in each column; and for each row a list of its blocks, from the last column to the first. */
static bool sort_rows(BlockLu *lu) {
    const size_t wanted = (size_t)lu->below + 1;
    if (!array_reserve((void **)&lu->next, &lu->next_capacity, wanted, sizeof *lu->next) ||
        !array_reserve((void **)&lu->owner, &lu->owner_capacity, wanted, sizeof *lu->owner))
        return false;
    for (int k = 0; k < lu->count; k++) lu->first[k] = -1;
    for (int k = 0; k < lu->count; k++) {
        for (int x = lu->column[k]; x < lu->column[k + 1]; x++) {
            const int32_t row = lu->position[lu->row[x]];
            int at = x;
            for (; at > lu->column[k] && lu->row[at - 1] > row; at--) lu->row[at] = lu->row[at - 1];
            lu->row[at] = row;
        }
        for (int x = lu->column[k]; x < lu->column[k + 1]; x++) {
            lu->owner[x] = k;
            lu->next[x] = lu->first[lu->row[x]];
            lu->first[lu->row[x]] = x;
        }
    }
    return true;
}

/* Column by column: which products of earlier columns change it. */
static bool list_updates(BlockLu *lu) {
    lu->update[0] = 0;
    for (int k = 0; k < lu->count; k++) {
        const int rows = lu->column[k + 1] - lu->column[k];
        lu->cursor[k] = lu->update[k];
        lu->update[k + 1] = lu->update[k] + rows * (rows - 1) / 2;
    }
    if (!array_reserve((void **)&lu->updates, &lu->updates_capacity, (size_t)lu->update[lu->count] + 1,
                       sizeof *lu->updates))
        return false;
    for (int j = 0; j < lu->count; j++) {
        for (int x = lu->column[j]; x < lu->column[j + 1]; x++) lu->find[lu->row[x]] = x;
        for (int right = lu->first[j]; right >= 0; right = lu->next[right]) {
            const int k = lu->owner[right];
            for (int left = right + 1; left < lu->column[k + 1]; left++)
                lu->updates[lu->cursor[k]++] = (BlockUpdate){lu->find[lu->row[left]], left, right};
        }
    }
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
    if (!reserve_nodes(lu, count, edge_count)) return false;
    lu->count = count;
    lu->edge_count = edge_count;
    if (size > 0) memcpy(lu->edges, edges, size);
    bool ok = choose_order(lu) && sort_rows(lu) && list_updates(lu) &&
              array_reserve((void **)&lu->blocks, &lu->block_capacity, (size_t)count + 2 * (size_t)lu->below + 3,
                            sizeof *lu->blocks);
    if (ok)
        place_edges(lu);
    else
        lu->edge_count = -1;
    return ok;
}
