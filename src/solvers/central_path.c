/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/central_path.h"

#include "interior/interior.h"
#include "sweeps/contact_velocity.h"

enum { FACTORIZATIONS = 200 }; /* those of the reference's first attempt */

static bool is_solved(const Reference *reference, const ContactProblem *problem, double near) {
    bool solved = reference->residual <= near;
    for (int i = 0; i < problem->contact_count; i++)
        solved &= reference->impulses[i].normal <= interior_impulse_max * (double)problem->contacts[i].mass_normal;
    return solved;
}

void central_path_free(CentralPath *path) { reference_free(&path->reference); }

bool central_path_reserve(CentralPath *path, const ContactProblem *problem, Error *error) {
    if (problem->body_count <= path->bodies && problem->contact_count <= path->contacts) return true;
    if (problem->body_count > path->bodies) path->bodies = problem->body_count;
    if (problem->contact_count > path->contacts) path->contacts = problem->contact_count;
    return reference_reserve(&path->reference, problem) || error_memory(error, "interior");
}

bool central_path_solve(CentralPath *path, const ContactProblem *problem, double near, ContactSolution *solution,
                        bool *solved, Error *error) {
    Reference *reference = &path->reference;
    if (!reference_solve_to(reference, problem, near, FACTORIZATIONS, error)) return false;
    *solved = is_solved(reference, problem, near);
    if (!*solved) return true;
    reference_round(reference, problem, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const float limit = problem->contacts[i].friction * solution->impulses[i].normal;
        solution->impulses[i].tangent = contact_clamp(solution->impulses[i].tangent, -limit, limit);
    }
    return true;
}
