/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain text of sequential impulses, contact by contact: what the fast sweeps (sweeps.h) are held to. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>

/* Sweeps `iterations` times over the contacts. accumulate: clamp the sum of impulses, from the warm start on, not
   each one. */
void sequential_impulses_solve(const ContactProblem *problem, int iterations, bool accumulate,
                               ContactSolution *solution);
