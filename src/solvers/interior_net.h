/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A solver interior-net with a network in memory, for training. */
#pragma once
#include "dynamics/contact_solver.h"
#include "network/interior_net.h"

/* Copies the network. False with error set when memory is short. */
bool interior_net_make(ContactSolver *solver, const InteriorNet *net, Error *error);
