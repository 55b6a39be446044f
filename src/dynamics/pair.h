/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A touching pair as the paper's network meets it (Avatavului, Ifrim, Voncila 2023, section 3.1): what the solver
   saw, and what it did to that pair. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>

/* How a network sees a pair. The paper has ten inputs, made of positions, velocities and angular velocities (section 3)
   or with rotations too (3.1), first as they are and then with the difference of the positions; so it can be read as

     relative     10: position of b relative to a, velocities, angular velocities, rotations
     raw          12: positions, velocities, angular velocities, rotations
     raw-unturned 10: positions, velocities, angular velocities */
typedef enum PairView { PAIR_RELATIVE, PAIR_RAW, PAIR_RAW_UNTURNED, PAIR_VIEWS } PairView;

enum { PAIR_INPUTS = 10, PAIR_INPUTS_MAX = 12, PAIR_CHANGES = 6 };

typedef struct PairViewInfo {
    const char *name;
    int count;
    const char *inputs; /* names of the numbers, separated by spaces */
} PairViewInfo;

extern const PairViewInfo pair_views[PAIR_VIEWS];
extern const char pair_change_names[];

/* The view of that name, or of those inputs; false where there is none. */
bool pair_view_find(const char *name, PairView *view);
bool pair_view_of_inputs(const char *inputs, PairView *view);

/* inputs[pair_views[view].count]. velocities [body_count]: those to show, NULL: the problem's. */
void pair_inputs(const ContactProblem *problem, const BodyVelocity *velocities, int a, int b, PairView view,
                 float *inputs);

/* What the pair's own impulses did over the step: change of velocity (2) and angular velocity (1) of a, then of b.
   first, count: the pair's contacts in the problem. */
void pair_changes(const ContactProblem *problem, const ContactSolution *solution, int first, int count,
                  float changes[PAIR_CHANGES]);

/* The number of contacts, from `first` on, that belong to the same pair. */
int pair_contact_count(const ContactProblem *problem, int first);
