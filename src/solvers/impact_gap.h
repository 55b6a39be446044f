/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far the cached impulses of the step before are from what this step asks for: nearly nothing while boxes rest,
   metres a second while a shock runs through them. Tells when a network is worth its time, and needs no memory of the
   steps before. */
#pragma once
#include "solvers/sweeps.h"

/* Whether the root of the mean square over the contacts, of how far a contact's normal velocity is from its bias after
   the warm start, reaches `gate` (m/s). What parts without being pushed is no miss. sweeps: begun with this problem,
   warm, and not yet run. */
bool impact_gap_reaches(const Sweeps *sweeps, const ContactProblem *problem, float gate);
