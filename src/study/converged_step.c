/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/converged_step.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>

void converged_step_free(ConvergedStep *converged) {
    reference_free(&converged->reference);
    free(converged->contacts);
    *converged = (ConvergedStep){0};
}

/* A negative bias lets a gap close; it stays. */
static bool remove_push_out(ConvergedStep *converged, ContactProblem *problem) {
    const size_t count = (size_t)problem->contact_count;
    if (!array_reserve((void **)&converged->contacts, &converged->contact_capacity, count, sizeof(ContactPoint)))
        return false;
    if (count > 0) memcpy(converged->contacts, problem->contacts, count * sizeof(ContactPoint));
    for (size_t i = 0; i < count; i++)
        if (converged->contacts[i].bias > 0) converged->contacts[i].bias = 0;
    problem->contacts = converged->contacts;
    return true;
}

bool converged_step_solve(ConvergedStep *converged, const ContactProblem *problem, bool push_out, Error *error) {
    ContactProblem solved = *problem;
    if (!push_out && !remove_push_out(converged, &solved)) return error_memory(error, "study");
    return reference_solve(&converged->reference, &solved, NULL, error);
}
