/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order in which a sparse factorization eliminates blocks: by exact degrees if few, else by approximate ones. */
#include "methods/block_order.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

enum { WORD = 64, EXACT_MAX = 128 }; /* EXACT_MAX: nodes that are ordered by exact degrees */

void block_order_free(BlockOrder *order) {
    free(order->words);
    free(order->list);
    free(order->arrays.memory);
    *order = (BlockOrder){0};
}

/* Exact degrees. */

static void set_bit(uint64_t *row, int bit) { row[bit / WORD] |= (uint64_t)1 << (bit % WORD); }
static void clear_bit(uint64_t *row, int bit) { row[bit / WORD] &= ~((uint64_t)1 << (bit % WORD)); }

/* Inline: not every CPU has an instruction for it, and a call of the compiler's library takes longer. */
static int bits_in(uint64_t word) {
    word -= word >> 1 & UINT64_C(0x5555555555555555);
    word = (word & UINT64_C(0x3333333333333333)) + (word >> 2 & UINT64_C(0x3333333333333333));
    word = (word + (word >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (int)(word * UINT64_C(0x0101010101010101) >> 56);
}

/* The nodes that are left: a row of bits per node, for its neighbours, and one per degree, for the nodes that have
   it. */
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
            int degree = 0;
            for (size_t x = 0; x < words; x++) degree += bits_in(row[x]);
            rows->degree[other] = degree;
            set_bit(rows->having + (size_t)degree * words, other);
            if (degree < rows->lowest) rows->lowest = degree;
        }
}

static bool by_exact_degrees(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    Rows rows;
    if (!load_rows(order, graph, &rows)) return false;
    for (int k = 0; k < graph->count; k++) {
        /* The node of the smallest degree; the first of several. */
        uint64_t *having = rows.having + (size_t)rows.lowest * rows.words, *end = having + rows.words;
        for (; *having == 0; having++) {
            if (having + 1 < end) continue;
            end += rows.words; /* the row of the next degree */
            rows.lowest++;
        }
        nodes[k] = ((int)(having - end) + (int)rows.words) * WORD + __builtin_ctzll(*having);
        *having &= *having - 1;
        eliminate(&rows, nodes[k]);
    }
    return true;
}

/* Approximate degrees. */

typedef struct Quotient {
    int count, lowest, ordered; /* ordered: nodes that are eliminated */
    int64_t mark;               /* above all of `seen` */
    size_t used;                /* of `list` */
    BlockOrder *order;
    int32_t *list;              /* = order->list: of a node its elements, then nodes; of an element its nodes */
    int32_t *length, *elements; /* of a list; how many of it are elements */
    int32_t *weight; /* nodes merged into this one, with it; 0: merged itself; negative: in the newest element */
    int32_t *degree; /* of a node at most; nodes in an element */
    int32_t *head, *next, *last; /* lists of nodes by degree */
    int32_t *bucket;             /* [count] nodes of the newest element by the sum of their lists; -1: empty */
    int32_t *follower, *tail;    /* the nodes that follow a node in the order, chained */
    int64_t *start, *seen;       /* seen: 0 for an absorbed element */
} Quotient;

static void link_node(Quotient *q, int node, int degree) {
    const int first = q->head[degree];
    q->degree[node] = degree;
    q->next[node] = first;
    q->last[node] = -1;
    if (first >= 0) q->last[first] = node;
    q->head[degree] = node;
    if (degree < q->lowest) q->lowest = degree;
}

static void unlink_node(Quotient *q, int node) {
    const int before = q->last[node], after = q->next[node];
    if (after >= 0) q->last[after] = before;
    if (before >= 0)
        q->next[before] = after;
    else
        q->head[q->degree[node]] = after;
}

static void chain(Quotient *q, int node, int follower) {
    q->weight[follower] = 0;
    q->follower[q->tail[node]] = follower;
    q->tail[node] = q->tail[follower];
}

/* Moves the nodes of a list into that of the new element, and out of the lists by degree. Returns their weight. */
static int collect(Quotient *q, int64_t from, int64_t end, int64_t *to) {
    int weight = 0;
    for (; from < end; from++) {
        const int node = q->list[from], mine = q->weight[node];
        if (mine <= 0) continue;
        weight += mine;
        q->weight[node] = -mine;
        q->list[(*to)++] = node;
        unlink_node(q, node);
    }
    return weight;
}

/* Makes the pivot an element of the nodes that it connects. */
static bool make_element(Quotient *q, int pivot) {
    /* Room behind all lists for the new element's. All lists together are no longer than the rows of the
       factorization. */
    size_t most = q->used + (size_t)q->length[pivot];
    for (int i = 0; i < q->elements[pivot]; i++) most += (size_t)q->length[q->list[q->start[pivot] + i]];
    if (!array_reserve((void **)&q->order->list, &q->order->list_capacity, most, sizeof *q->list)) return false;
    q->list = q->order->list;
    const int64_t own = q->start[pivot], begin = q->elements[pivot] == 0 ? own : (int64_t)q->used;
    int64_t end = begin;
    int weight = 0;
    q->weight[pivot] = -q->weight[pivot];
    for (int i = 0; i < q->elements[pivot]; i++) {
        const int element = q->list[own + i];
        weight += collect(q, q->start[element], q->start[element] + q->length[element], &end);
        q->seen[element] = 0;
    }
    weight += collect(q, own + q->elements[pivot], own + q->length[pivot], &end);
    if (begin != own) q->used = (size_t)end;
    q->start[pivot] = begin;
    q->length[pivot] = (int32_t)(end - begin);
    q->degree[pivot] = weight;
    return true;
}

/* Removes what is absorbed or connected by the pivot from a node's list, and adds the pivot as its first element.
   Returns the weight that it has beyond the pivot; 0: it is eliminated with the pivot. */
static int shorten(Quotient *q, int node, int pivot, uint32_t *sum) {
    int32_t *list = q->list + q->start[node];
    int kept = 0, weight = 0;
    for (int k = 0; k < q->elements[node]; k++) {
        const int element = list[k], beyond = (int)(q->seen[element] - q->mark);
        if (q->seen[element] == 0) continue;
        if (beyond == 0) q->seen[element] = 0;
        if (beyond == 0) continue;
        weight += beyond;
        *sum += (uint32_t)(list[kept++] = element);
    }
    const int elements = kept;
    for (int k = q->elements[node]; k < q->length[node]; k++) {
        const int other = list[k];
        if (q->weight[other] <= 0) continue;
        weight += q->weight[other];
        *sum += (uint32_t)(list[kept++] = other);
    }
    /* There is room: it had the pivot, or an element that the pivot absorbed. */
    list[kept] = list[elements];
    list[elements] = list[0];
    list[0] = pivot;
    q->length[node] = kept + 1;
    q->elements[node] = elements + 1;
    return weight;
}

static void update_nodes(Quotient *q, int pivot) {
    /* `seen` of each element that has nodes in common with the new one: mark and the weight that it has beyond. */
    for (int i = 0; i < q->length[pivot]; i++) {
        const int node = q->list[q->start[pivot] + i];
        for (int k = 0; k < q->elements[node]; k++) {
            const int element = q->list[q->start[node] + k];
            if (q->seen[element] == 0) continue;
            if (q->seen[element] < q->mark) q->seen[element] = q->mark + q->degree[element];
            q->seen[element] += q->weight[node]; /* which is negative */
        }
    }
    for (int i = 0; i < q->length[pivot]; i++) {
        const int node = q->list[q->start[pivot] + i];
        uint32_t sum = 0;
        const int weight = shorten(q, node, pivot, &sum);
        if (weight == 0) {
            q->degree[pivot] += q->weight[node];
            q->weight[pivot] += q->weight[node];
            chain(q, pivot, node);
            continue;
        }
        if (weight < q->degree[node]) q->degree[node] = weight;
        const int bucket = (int)(sum % (uint32_t)q->count);
        q->next[node] = q->bucket[bucket];
        q->last[node] = bucket;
        q->bucket[bucket] = node;
    }
}

/* Merges the nodes of a bucket that have the same list as `node`. */
static void merge_equal(Quotient *q, int node) {
    q->mark++;
    for (int k = 1; k < q->length[node]; k++) q->seen[q->list[q->start[node] + k]] = q->mark;
    for (int before = node, other = q->next[node]; other >= 0; other = q->next[before]) {
        bool equal = q->length[node] == q->length[other] && q->elements[node] == q->elements[other];
        for (int k = 1; equal && k < q->length[other]; k++) equal = q->seen[q->list[q->start[other] + k]] == q->mark;
        if (!equal) {
            before = other;
            continue;
        }
        q->weight[node] += q->weight[other];
        chain(q, node, other);
        q->next[before] = q->next[other];
    }
}

static void merge_nodes(Quotient *q, int pivot) {
    q->mark += q->count + 1;
    for (int i = 0; i < q->length[pivot]; i++) {
        int node = q->list[q->start[pivot] + i];
        if (q->weight[node] == 0) continue;
        const int bucket = q->last[node];
        node = q->bucket[bucket];
        q->bucket[bucket] = -1;
        for (; node >= 0 && q->next[node] >= 0; node = q->next[node]) merge_equal(q, node);
    }
    q->mark++;
}

/* Back into the lists by degree; those that are merged leave the element. */
static void end_element(Quotient *q, int pivot) {
    int kept = 0, left = q->count - q->ordered;
    for (int i = 0; i < q->length[pivot]; i++) {
        const int node = q->list[q->start[pivot] + i], weight = -q->weight[node];
        if (weight == 0) continue;
        const int degree = q->degree[node] + q->degree[pivot] - weight;
        q->weight[node] = weight;
        link_node(q, node, degree < left - weight ? degree : left - weight);
        q->list[q->start[pivot] + kept++] = node;
    }
    q->length[pivot] = kept;
    q->seen[pivot] = kept > 0;
}

static bool by_approximate_degrees(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    const size_t count = (size_t)graph->count, used = (size_t)graph->start[count];
    Quotient q = {.count = graph->count, .lowest = graph->count, .used = used, .order = order, .mark = 2};
    if (!array_reserve((void **)&order->list, &order->list_capacity, used + 1, sizeof *order->list) ||
        !ARRAY_BLOCK_RESERVE(&order->arrays, ARRAY_PART(q.length, count), ARRAY_PART(q.elements, count),
                             ARRAY_PART(q.weight, count), ARRAY_PART(q.degree, count), ARRAY_PART(q.head, count + 1),
                             ARRAY_PART(q.next, count), ARRAY_PART(q.last, count), ARRAY_PART(q.bucket, count),
                             ARRAY_PART(q.follower, count), ARRAY_PART(q.tail, count), ARRAY_PART(q.start, count),
                             ARRAY_PART(q.seen, count)))
        return false;
    q.list = order->list;
    memcpy(q.list, graph->neighbour, used * sizeof *q.list);
    for (int i = 0; i <= q.count; i++) q.head[i] = -1;
    for (int i = 0; i < q.count; i++) {
        q.start[i] = graph->start[i];
        q.length[i] = graph->start[i + 1] - graph->start[i];
        q.elements[i] = 0;
        q.weight[i] = 1;
        q.bucket[i] = q.follower[i] = -1;
        q.tail[i] = i;
        q.seen[i] = 1;
        link_node(&q, i, q.length[i]);
    }
    while (q.ordered < q.count) {
        while (q.head[q.lowest] < 0) q.lowest++;
        const int pivot = q.head[q.lowest];
        unlink_node(&q, pivot);
        if (!make_element(&q, pivot)) return false;
        update_nodes(&q, pivot);
        for (int node = pivot; node >= 0; node = q.follower[node]) nodes[q.ordered++] = node;
        merge_nodes(&q, pivot);
        end_element(&q, pivot);
    }
    return true;
}

bool block_order_choose(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    return graph->count <= EXACT_MAX ? by_exact_degrees(order, graph, nodes)
                                     : by_approximate_degrees(order, graph, nodes);
}
