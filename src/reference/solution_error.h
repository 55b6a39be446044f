/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of a method's velocities against the reference. Only dynamic bodies (inv_mass > 0) count. Spin has the
   weight that it has in the kinetic energy of a unit box: m v^2 / 2 + m w^2 / 12 = m (v^2 + w^2 / 6) / 2. */
#pragma once
#include "dynamics/contact_problem.h"
#include "reference/reference.h"

typedef struct SolutionError {
    double rms;  /* m/s: root of the mean over the bodies of |dv|^2 + dspin^2 / 6; 0 without bodies */
    int right;   /* bodies with a right velocity */
    int counted; /* dynamic bodies */
    int worst;   /* the body with the largest |dv|^2 + dspin^2 / 6; -1: none */
} SolutionError;

/* velocities, reference: [problem->body_count]. A body's velocity is right if |v - v*| <= max(0.05 m/s, 5% of |v* -
   v_free|), with |.|^2 = x^2 + y^2 + (spin / 2)^2 and v_free the problem's velocity, before any impulse. A NaN or
   infinite velocity is wrong; the error is then infinite. */
SolutionError solution_error(const ContactProblem *problem, const BodyVelocity *velocities,
                             const ReferenceVelocity *reference);
