/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference (reference/reference.h) as a contact solver, for runs of converged steps. A step that does not
   converge ends with its best answer. */
#include "reference/reference.h"
#include "solvers/solvers.h"

#include <stdlib.h>

static void *create(const Settings *chosen, Error *error) {
    (void)chosen;
    Reference *reference = calloc(1, sizeof *reference);
    if (reference == NULL) error_memory(error, "reference");
    return reference;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Reference *reference = state;
    if (!reference_solve(reference, problem, NULL, error)) return false;
    reference_round(reference, problem, solution);
    return true;
}

static void destroy(void *state) {
    Reference *reference = state;
    if (reference == NULL) return;
    reference_free(reference);
    free(reference);
}

const ContactSolverKind solver_reference = {
    .description = {.name = "reference",
                    .summary = "the converged solution, by interior points in double; errors are measured against it",
                    .caption = "converged solution",
                    .look = {METHOD_BLACK, METHOD_CIRCLE},
                    .role = METHOD_REFERENCE,
                    .stability_place = 6},
    .create = create,
    .solve = solve,
    .destroy = destroy};
