/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Graph colouring of the contacts: pairs of one colour share no moving body, so their visits commute. A sweep in this
   order has one level (sweeps.h) per colour, instead of one per body of the longest chain, and a schedule needs two
   sweeps only.

   Greedy, from the last pair to the first: each takes the lowest colour that neither of its moving bodies has yet.
   Bodies are numbered from the ground up and the bomb last, so the bomb's contacts are visited first. Source: Harada,
   "A Parallel Constraint Solver for a Rigid Body Simulation" (2011), which batches contacts this way for a GPU. Fails
   sooner than the engine's order, from the ground up, for a tall stack under a heavy load. The engine keeps its own
   order, for the bits of Box2D-Lite. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { COLOURS = 64 };

/* Zero-initialise; arrays grow and are reused. */
typedef struct Colours {
    int32_t *visits; /* [contact_count] the contacts in the order of visits; the two of a pair stay adjacent */
    int32_t *pairs;  /* [pairs + 1] the first contact of each pair, and the end */
    uint8_t *colour; /* [pairs] */
    uint64_t *taken; /* [body_count] one bit per colour */
    size_t visit_capacity, pair_capacity, colour_capacity, taken_capacity;
} Colours;

void colours_free(Colours *colours);

/* Returns the lowest colour that is free in `taken` (one bit per colour) for both moving bodies of the contact, and
   takes it. If all are taken: the last colour, whose visits do not commute and keep their order. */
static inline int colours_take(uint64_t *taken, const ContactProblem *problem, const ContactPoint *contact) {
    uint64_t *a = &taken[contact->a], *b = &taken[contact->b];
    const uint64_t open = ~(*a | *b);
    const int colour = open != 0 ? __builtin_ctzll(open) : COLOURS - 1;
    *a |= (uint64_t)problem_body_moves(&problem->bodies[contact->a]) << colour;
    *b |= (uint64_t)problem_body_moves(&problem->bodies[contact->b]) << colour;
    return colour;
}

/* Fills colours->visits. False when memory is short. */
bool colours_order(Colours *colours, const ContactProblem *problem);
