/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Islands: bodies that contacts connect, through bodies that move. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stddef.h>

/* Work space. Zero-initialise; arrays grow and are reused. */
typedef struct Islands {
    int32_t *parent, *loops; /* [body_count] */
    size_t parent_capacity, loop_capacity;
} Islands;

void islands_free(Islands *islands);

/* The loops of the island that has most: touching pairs of its moving bodies that could open without dividing it. A
   stack has none, a pyramid or a wall almost as many as boxes. A factorization fills in only where loops are. -1 when
   memory is short. */
int islands_most_loops(Islands *islands, const ContactProblem *problem);
