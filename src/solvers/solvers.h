/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of methods. To add a contact solver, write one file in this folder that defines solver_NAME, and add one
   line SOLVER(NAME) here. */
#pragma once
#include "dynamics/contact_solver.h"

/* In the order of lists and charts. SOLVER(x) is solver_x of this folder; STEPPING(x) is stepping_x of simulate/, for
   methods that need more than one solver call in a step (simulate/stepping.h). New methods go to the end: lines of a
   chart get their colours in this order. */
#define METHODS(SOLVER, STEPPING) \
    SOLVER(engine)                \
    SOLVER(over_relaxation)       \
    SOLVER(momentum)              \
    SOLVER(block)                 \
    SOLVER(nncg)                  \
    STEPPING(substepping)         \
    SOLVER(pair_net)              \
    SOLVER(contact_net)           \
    SOLVER(scene_net)             \
    SOLVER(constant)              \
    STEPPING(playback)            \
    SOLVER(reference)             \
    SOLVER(relu_net)              \
    STEPPING(soft_step)           \
    STEPPING(avbd)                \
    SOLVER(interior)              \
    SOLVER(sain)                  \
    SOLVER(hybrid)                \
    STEPPING(gns)                 \
    STEPPING(subspace)

#define METHOD_OMITTED(name)
#define SOLVER_DECLARED(name) extern const ContactSolverKind solver_##name;
METHODS(SOLVER_DECLARED, METHOD_OMITTED)
#undef SOLVER_DECLARED
