/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of the impulses in a set of sweeps: how far contacts are from their target velocities. After the warm
   start it is near zero while boxes rest, and metres per second while a shock travels through them; so it tells whether
   a step is worth a network. After sweeps it tells whether they have converged. */
#pragma once
#include "sweeps/sweeps.h"

/* True if the root mean square over the contacts of (bias - normal velocity) is at least `limit` (m/s). Separating
   contacts without an impulse do not count as error. */
bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit);

/* The same of a solution. Where the sweeps visit contacts in the problem's order, with the same answer. */
bool residual_reaches_scalar(const ContactProblem *problem, const ContactSolution *solution, float limit);

/* True if the root mean square over the contacts of what one more visit would change, normal and tangent velocity, is at
   least `limit` (m/s), or NaN. This is the residual of interior/interior.h. */
bool residual_of_visits_reaches(const Sweeps *sweeps, int contact_count, float limit);

/* True if the bodies of a contact move relative to each other by at least `limit` (m/s) there without any impulse, in any
   direction, or by NaN. A step of gravity makes 0.17 at rest, whatever the masses. */
bool residual_motion_reaches(const ContactProblem *problem, float limit);
