/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound of the work that a step of interior takes. */
#pragma once

/* In sweeps over an island's contacts: 30 times the engine's ten. A bomb of 1e5 times the mass of a pyramid's boxes
   leaves three times the error with 20 times, and the same with 40. */
enum { INTERIOR_MOST_WORK = 300 };

/* The most that the last step took for an island, by a count of what was done; never above the bound. */
double interior_work_done(const void *state);
