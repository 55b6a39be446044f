/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound of the work that a step of interior takes. */
#pragma once

/* In sweeps over an island's contacts: 100 times the engine's ten sweeps, or 20 times where more than 128 bodies move.
   With 200 for all, half of the impacts on walls and pyramids of a hundred boxes end worse than momentum in the same
   time. */
enum { INTERIOR_MOST_WORK = 1000, INTERIOR_MOST_WORK_OF_MANY = 200 };

/* The most that the last step took for an island, by a count of what was done; never above the bound. */
double interior_work_done(const void *state);
