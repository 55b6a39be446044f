/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far the impulses that sweeps hold are from what a step asks for. After the warm start: nearly nothing while boxes
   rest, metres a second while a shock runs through them; so it tells when a network is worth its time. After some
   sweeps: whether they have arrived. */
#pragma once
#include "sweeps/sweeps.h"

/* Whether the root of the mean square over the contacts, of how far a contact's normal velocity is from its bias, reaches
   `gate` (m/s). What parts without being pushed is no miss. */
bool impact_gap_reaches(const Sweeps *sweeps, int contact_count, float gate);
