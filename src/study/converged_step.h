/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The converged solution that a step is scored against. For most methods it is that of the step's contact problem. A
   method that moves overlapping bodies apart without giving them a velocity (no_push_out in its description) solves
   another problem: the same one without the bias that pushes bodies apart. */
#pragma once
#include "reference/reference.h"
#include "simulate/method.h"

/* Zero-initialise; free with converged_step_free. */
typedef struct ConvergedStep {
    Reference reference; /* of the last solve: velocities, residual */
    ContactPoint *contacts;
    size_t contact_capacity;
} ConvergedStep;

void converged_step_free(ConvergedStep *converged);

/* Solves to REFERENCE_TOLERANCE. push_out: with the bias of overlapping contacts. False when memory is short. */
bool converged_step_solve(ConvergedStep *converged, const ContactProblem *problem, bool push_out, Error *error);
