/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Problems that `interior` leaves to sweeps with momentum. The time of a factorization grows with the power 1.5 of the
   bodies in an island (interior/islands.h); an iteration takes as long as 20 sweeps at 496 boxes in a pyramid, 45 at
   1,275 and 120 at 4,950. Beyond about 750 boxes sweeps are as accurate in the same time. Stacks and rows of any number
   of bodies have no loops, and are not left to sweeps.

   Interior-point steps only for the bodies that sweeps leave unsolved, with the impulses of all others kept, gain nothing
   on average: on eight frozen impacts of 1,276 and 2,401 boxes the error at equal time was 1.2 to 1.4 times that of sweeps
   (geometric mean). They help where a wall is struck from the side. Under the top of a pyramid all impulses change down
   to the ground. */
#pragma once
#include "interior/islands.h"
#include "solvers/momentum.h"

enum { LARGE_SWEEPS = 20, LARGE_MORE = 96 }; /* sweeps, and those that may follow while the residual is too large */

/* Zero-initialise. */
typedef struct LargeIslands {
    Islands islands;
    float factors[LARGE_SWEEPS], more_factors[LARGE_MORE];
} LargeIslands;

void large_islands_init(LargeIslands *large);
void large_islands_free(LargeIslands *large);

/* Whether the problem is to be left to sweeps. False with error set when memory is short. */
bool large_islands_find(LargeIslands *large, const ContactProblem *problem, bool *left_to_sweeps, Error *error);

/* Sweeps until the residual (solvers/residual.h) is below `near` (m/s). */
bool large_islands_solve(const LargeIslands *large, Momentum *momentum, float near, const ContactProblem *problem,
                         ContactSolution *solution, Error *error);
