/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the training of interior-net shares with the method (solvers/interior.c). */
#pragma once
#include "dynamics/contact_solver.h"
#include "network/interior_net.h"

enum { INTERIOR_IMPACT_SWEEPS = 6 }; /* with momentum, at the start of a step that is not at rest */

#define INTERIOR_REST_BELOW 1.2f   /* m/s, see interior.c */
#define INTERIOR_IMPACT_SCALE 0.01 /* m/s, `least_scale` of the first attempt (interior.h) */

/* A solver with a network in memory, which it copies. False with error set when memory is short. */
bool interior_net_make(ContactSolver *solver, const InteriorNet *net, Error *error);
