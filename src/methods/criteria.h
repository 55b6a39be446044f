/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the literature compares solvers of contacts by: how far a solution is from each law of contact. The residual of
   the reference (methods/reference.h) is one number for all of them; these tell which law is broken. Sources: Le Lidec,
   Jallet, Montaut, Laptev, Schmid, Carpentier, "Contact Models in Robotics: a Comparative Analysis" (arXiv 2304.06372,
   2023); Tsounis, Grandia, Bächer, "On Solving the Dynamics of Constrained Rigid Multi-Body Systems with Kinematic
   Loops" (arXiv 2504.19771, 2025). They scale impulses in ways of their own; here all have units. */
#pragma once
#include "engine/engine.h"

#include <stdbool.h>

/* Of one step. At a contact p is the impulse, u the velocity of b relative to a after the step, g = u_n - bias how fast
   the gap opens beyond its target, and mu the friction. Each is 0 for a solution, but for penetration and energy, which
   are to be compared with the reference's. */
typedef struct ContactCriteria {
    double signorini;   /* J, largest |g p_n|: no impulse where a gap opens */
    double cone;        /* N s, largest distance of (p_n, p_t) from the cone |p_t| <= mu p_n */
    double dissipation; /* J, largest |mu p_n |u_t| + p_t u_t|: friction takes the most energy that it can */
    double penetration; /* m, deepest contact once the bodies have moved on by dt */
    double energy;      /* J, kinetic energy after the step minus that before any impulse */
} ContactCriteria;

/* velocities [body_count] and impulses [contact_count] of a solution. push_out: whether position correction is part of
   what it solves; else a positive bias counts as 0. The first three are NaN where contacts have no impulses, as of a
   method without them, and all five are infinite if a number is NaN or infinite. */
ContactCriteria contact_criteria(const ContactProblem *problem, const ContactSolution *solution, bool push_out);
