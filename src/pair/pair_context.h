/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a touching pair that the laws of physics (training/law_terms.h) need, beyond the inputs of a network. */
#pragma once
#include "dynamics/contact_problem.h"

/* Indices into a pair's context. Vectors in world axes. */
enum {
    CONTEXT_INV_MASS_A,    /* 1/kg, 0 for a static body */
    CONTEXT_INV_INERTIA_A, /* 1/(kg m^2) */
    CONTEXT_INV_MASS_B,
    CONTEXT_INV_INERTIA_B,
    CONTEXT_NORMAL,          /* (2) unit, from a to b */
    CONTEXT_FRICTION = 6,    /* coefficient */
    CONTEXT_ARM_A,           /* (2) m, from the centre of a to the middle of the pair's points */
    CONTEXT_ARM_B = 9,       /* (2) */
    CONTEXT_VELOCITIES = 11, /* (6) before the step's impulses: velocity, angular velocity of a, then of b */
    PAIR_CONTEXT = 17
};

/* Fills the context of the pair whose contacts begin at `first`. */
void pair_context(const ContactProblem *problem, int first, float context[PAIR_CONTEXT]);

/* Returns why a context of finite numbers is invalid, or NULL. */
const char *pair_context_fault(const float context[PAIR_CONTEXT]);
