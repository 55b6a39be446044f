/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum: in plain text, and as the solvers use them, in the order of colours (colours.h). Which factor
   stands before which sweep is theirs to say. */
#pragma once
#include "common/error.h"
#include "sweeps/sweeps.h"

/* The plain text: `count` sweeps over the contacts visits[contact_count], before sweep s (not the first) the extrapolation
   by factors[s] >= 0. `before` is room for another solution. sweeps_run_momentum gives the same bits. */
void momentum_solve_plain(const ContactProblem *problem, const int32_t *visits, const float *factors, int count,
                          ContactSolution *before, ContactSolution *solution);

/* The factor before a sweep (from 0 on) of `count`, set by hand: s / (s + 1.4), at most 1 - 7 / (15 + count). Few sweeps
   have no time to take back what a large factor overshoots. Fitted to the launches of stack and pyramids together. */
float momentum_factor_by_hand(int sweep, int count);

/* Zero-initialise; arrays grow and are reused. */
typedef struct Momentum {
    Sweeps sweeps;
    ContactSolution before; /* where numbers are not finite: room for the plain text */
    size_t body_capacity, contact_capacity;
} Momentum;

void momentum_free(Momentum *momentum);

/* The fast sweeps, or the plain text where those left the finite numbers. */
bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error);
