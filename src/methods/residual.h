/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of the impulses in a set of sweeps: how far contacts are from their target velocities. After the warm
   start it is near zero while boxes rest, and metres per second while a shock travels through them; so it tells
   whether a step is worth a network. After sweeps it tells whether they have converged. */
#pragma once
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdbool.h>

/* True if the root mean square over the contacts of (bias - normal velocity) is at least `limit` (m/s). Separating
   contacts without an impulse do not count as error. */
bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit);

/* The same of a solution. Where the sweeps visit contacts in the problem's order, with the same answer. */
bool residual_reaches_scalar(const ContactProblem *problem, const ContactSolution *solution, float limit);

/* (m/s)^2, summed over the contacts of a pair of the sweeps: what one more visit would change, normal and tangent
   velocity. NaN if a velocity of its bodies is NaN or infinite. Its root mean square over the contacts is the residual
   of methods/interior_point_internal.h. */
float residual_of_pair(const Sweeps *sweeps, int pair);

/* squared[pair_count]: the same of all pairs, by the sweeps' kernel. */
void residual_of_pairs(const Sweeps *sweeps, float *squared);

/* overshoot[pair_count]: the share of a contact's error by which a visit carries its normal velocity past the aim,
   because it slides, or is new and will slide: mu |knt| / knn, where the friction acts against the normal velocity; the
   larger of the pair's points, else 0. knn: what a normal impulse changes the normal velocity by, 1 / mass_normal; knt:
   what an impulse along the tangent does. For boxes |knt| / knn is at most sqrt(3) / 2, as no point is further from the
   centre than a corner. */
void overshoot_of_pairs(const Sweeps *sweeps, float *overshoot);

/* (m/s)^2: how the bodies of a contact move relative to each other there without any impulse, in any direction; or NaN.
   A step of gravity makes 0.17 m/s at rest, whatever the masses. */
float residual_of_motion(const ContactProblem *problem, int contact);
