/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work of interior. */
#pragma once

/* The most work that the last step took for an island, in sweeps over its contacts, by a count of what was
   done. At most INTERIOR_MOST_WORK, 100 times the engine's ten sweeps; or that OF_MANY, 20 times, where more than 128 bodies move.
   With 200 for all, half of the impacts on walls and pyramids of a hundred boxes end worse than momentum in the same time. */
enum { INTERIOR_MOST_WORK = 1000, INTERIOR_MOST_WORK_OF_MANY = 200 };
double interior_work_done(const void *state);
