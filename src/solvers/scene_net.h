/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method scene-net with a network in memory, for training. */
#pragma once
#include "dynamics/contact_solver.h"
#include "network/slot_network.h"

/* The network remains the caller's and must outlive the solver. near: the setting, m/s. */
bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, float near, Error *error);
