/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The momentum_error of methods without impulses: where no contact is, only gravity may change a momentum. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>

/* N s: the sum over bodies without a contact of the momentum that they gained besides gravity's. touched[body_count] is
   work space. */
float free_flight_momentum(const ContactProblem *problem, const ContactSolution *solution, bool *touched);
