/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A touching pair as the paper's network meets it (Avatavului, Ifrim, Voncila 2023, section 3.1): what the solver
   saw, and what it did to that pair. */
#pragma once
#include "dynamics/contact_problem.h"

enum { PAIR_INPUTS = 10, PAIR_CHANGES = 6 };

/* Names of the numbers, separated by spaces. */
extern const char pair_input_names[], pair_change_names[];

/* The ten inputs: position of b relative to a (2), velocity of a (2) and of b (2), angular velocity of a and b,
   rotation of a and b. */
void pair_inputs(const ContactProblem *problem, int a, int b, float inputs[PAIR_INPUTS]);

/* What the pair's own impulses did over the step: change of velocity (2) and angular velocity (1) of a, then of b.
   first, count: the pair's contacts in the problem. */
void pair_changes(const ContactProblem *problem, const ContactSolution *solution, int first, int count,
                  float changes[PAIR_CHANGES]);

/* The number of contacts, from `first` on, that belong to the same pair. */
int pair_contact_count(const ContactProblem *problem, int first);
