/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method sain with a network in memory, for training. */
#pragma once
#include "dynamics/contact_solver.h"
#include "relation/relation_network.h"

/* The networks remain the caller's and must outlive the solver. False with error set when memory is short. */
bool sain_make(ContactSolver *solver, const RelationNetwork *network, RelationForm form, Error *error);
