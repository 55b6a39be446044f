/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step by the reference (reference/reference.h), which follows the central path from its beginning, also where it turns
   back, but only to a given residual: 10 to 30 factorizations where iterations of `interior` fail, rarely more than 100. */
#pragma once
#include "reference/reference.h"

/* Stores the solution and sets *solved if the residual (of Reference) is at most `near` (m/s) after 200 factorizations,
   and float can hold the impulses. Else the solution is not changed. False with error set when memory is short. */
bool central_path_solve(Reference *path, const ContactProblem *problem, double near, ContactSolution *solution,
                        bool *solved, Error *error);
