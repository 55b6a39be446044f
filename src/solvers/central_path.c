/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/central_path.h"

#include "interior/interior.h"
#include "sweeps/contact_velocity.h"

enum { FACTORIZATIONS = 200 }; /* those of the reference's first attempt */

static bool is_solved(const Reference *path, const ContactProblem *problem, double near) {
    bool solved = path->residual <= near;
    for (int i = 0; i < problem->contact_count; i++)
        solved &= path->impulses[i].normal <= interior_impulse_max * (double)problem->contacts[i].mass_normal;
    return solved;
}

bool central_path_solve(Reference *path, const ContactProblem *problem, double near, ContactSolution *solution,
                        bool *solved, Error *error) {
    if (!reference_solve_to(path, problem, near, FACTORIZATIONS, error)) return false;
    *solved = is_solved(path, problem, near);
    if (!*solved) return true;
    reference_round(path, problem, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const float limit = problem->contacts[i].friction * solution->impulses[i].normal;
        solution->impulses[i].tangent = contact_clamp(solution->impulses[i].tangent, -limit, limit);
    }
    return true;
}
