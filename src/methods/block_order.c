/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order in which a sparse factorization eliminates blocks: by exact degrees if few, else by approximate ones. */
#include "methods/block_order.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

enum { EXACT_MAX = 128 }; /* nodes that are ordered by exact degrees */

void block_order_free(BlockOrder *order) {
    free(order->adjacent);
    free(order->list);
    free(order->arrays.memory);
    *order = (BlockOrder){0};
}

/* A byte for each two nodes: whether they are neighbours. */
static bool by_exact_degrees(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes) {
    const int count = graph->count;
    int degree[EXACT_MAX]; /* -1: eliminated */
    const size_t size = (size_t)count * (size_t)count;
    if (!array_reserve((void **)&order->adjacent, &order->adjacent_capacity, size + 1, sizeof *order->adjacent))
        return false;
    memset(order->adjacent, 0, size);
    for (int i = 0; i < count; i++) {
        degree[i] = graph->start[i + 1] - graph->start[i];
        for (int x = graph->start[i]; x < graph->start[i + 1]; x++)
            order->adjacent[i * count + graph->neighbour[x]] = 1;
    }
    for (int k = 0; k < count; k++) {
        int node = -1; /* of the smallest degree; the first of several */
        for (int i = 0; i < count; i++)
            if (degree[i] >= 0 && (node < 0 || degree[i] < degree[node])) node = i;
        nodes[k] = node;
        degree[node] = -1;
        /* Its neighbours become each other's. */
        const uint8_t *mine = order->adjacent + node * count;
        for (int other = 0; other < count; other++) {
            if (!mine[other]) continue;
            uint8_t *row = order->adjacent + other * count;
            int sum = 0;
            for (int x = 0; x < count; x++) row[x] |= mine[x];
            row[other] = row[node] = 0;
            for (int x = 0; x < count; x++) sum += row[x];
            degree[other] = sum;
        }
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
