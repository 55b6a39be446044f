/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An order of visits by colours: pairs of bodies of one colour share no moving body, so their visits commute and a sweep
   over them has as many levels (sweeps.h) as there are colours, not as many as the longest chain of bodies. Two sweeps
   are schedule enough then.

   Greedy, from the last pair to the first: each takes the lowest colour that neither of its moving bodies has yet. Bodies
   are numbered from the ground up and the bomb last, so a blow is visited before what it reaches. Source: Harada, "A
   Parallel Constraint Solver for a Rigid Body Simulation" (2011), which batches contacts so for a graphics processor.
   Fails sooner than the engine's order, from the ground up, where a tall stack stands under a heavy load. The engine
   keeps its order, as its bits are Box2D-Lite's. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { COLOURS = 64 };

/* Zero-initialise; arrays grow and are reused. */
typedef struct Colours {
    int32_t *visits; /* [contact_count] the contacts in the order of visits; the two of a surface stay together */
    int32_t *pairs;  /* [pairs + 1] the first contact of each, and the end */
    uint8_t *colour; /* [pairs] */
    uint64_t *taken; /* [body_count] a bit for each colour */
    size_t visit_capacity, pair_capacity, colour_capacity, taken_capacity;
} Colours;

void colours_free(Colours *colours);

/* The lowest colour that neither moving body of the contact has taken [body_count, a bit for each colour], and takes it
   for both. What finds none free gets the last: it commutes no more, but has its place. */
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
