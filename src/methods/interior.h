/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bound of the work that a step of interior takes. */
#pragma once

/* In sweeps over an island's contacts: 30 times the engine's ten. With 20 times, a heavy box that strikes a pyramid
   leaves three times the error; with 40, hardly less. */
enum { INTERIOR_MOST_WORK = 300 };

/* The most that the last step took for an island, by a count of what was done; never above the bound. */
double interior_work_done(const void *state);
