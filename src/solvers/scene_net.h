/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method scene-net with a network that is in memory, for who trains it. */
#pragma once
#include "dynamics/contact_solver.h"
#include "network/slot_network.h"

/* The network stays the caller's, and lasts as long as the solver. near: the setting, m/s. */
bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, float near, Error *error);
