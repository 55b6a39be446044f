/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order in which the nodes of a graph are eliminated, for little fill in a factorization: the node of the smallest
   degree first. Up to 128 nodes by exact degrees, with a row of bits per node: half the time of AMD at 66 boxes. Larger
   graphs by AMD of SuiteSparse, whose approximate degrees need no such rows. Own orders lost to it: at 496 to 4,950
   boxes whose neighbours touch, nested dissection with exact degrees in the parts took 1 to 2.7 times as long and left
   8% to 34% more to multiply.
   Sources: George, Liu, "The Evolution of the Minimum Degree Ordering Algorithm" (1989); Amestoy, Davis, Duff,
   "Algorithm 837: AMD, an Approximate Minimum Degree Ordering Algorithm" (2004). Depends on nothing but the graph. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Node i has the neighbours neighbour[start[i]] to neighbour[start[i + 1] - 1], each once, in both directions, and not
   itself. */
typedef struct BlockNeighbours {
    int count;
    const int32_t *start, *neighbour;
} BlockNeighbours;

/* Work space. Zero-initialise; arrays grow and are reused. */
typedef struct BlockOrder {
    uint64_t *words;
    int32_t *numbers;
    size_t word_capacity, number_capacity;
} BlockOrder;

void block_order_free(BlockOrder *order);

/* Sets nodes[count], from the first that is eliminated to the last. False when memory is short. */
bool block_order_choose(BlockOrder *order, const BlockNeighbours *graph, int32_t *nodes);
