/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface that every contact solver implements: a constant struct of functions, listed once in
   solvers/solvers.h. */
#pragma once
#include "common/error.h"
#include "common/method_description.h"
#include "dynamics/contact_problem.h"

typedef struct ContactSolverKind {
    MethodDescription description;
    /* Returns the solver's own state, NULL with error set if a setting is refused. */
    void *(*create)(const Settings *settings, Error *error);
    ContactSolve *solve;
    void (*destroy)(void *state);
} ContactSolverKind;

/* A solver in use. */
typedef struct ContactSolver {
    const ContactSolverKind *kind;
    void *state;
} ContactSolver;
