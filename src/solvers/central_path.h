/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step by the reference (reference/reference.h), which follows the central path from its beginning, also where it turns
   back, but only to a given residual: 10 to 30 factorizations where iterations of `interior` fail, rarely more than 100. */
#pragma once
#include "reference/reference.h"

/* Zero-initialise. */
typedef struct CentralPath {
    Reference reference;
    int bodies, contacts; /* of the largest problems so far */
} CentralPath;

void central_path_free(CentralPath *path);

/* Allocates what a solve needs if the problem is larger than those before, so that the step that does need it allocates
   nothing. False with error set when memory is short. */
bool central_path_reserve(CentralPath *path, const ContactProblem *problem, Error *error);

/* Stores the solution and sets *solved if the residual (of Reference) is at most `near` (m/s) after 200 factorizations,
   and float can hold the impulses. Else the solution is not changed. False with error set when memory is short. */
bool central_path_solve(CentralPath *path, const ContactProblem *problem, double near, ContactSolution *solution,
                        bool *solved, Error *error);
