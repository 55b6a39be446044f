/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/reference_parts.h"
#include "sweeps/sweeps.h"

#include <limits.h>

static const ReferenceKernels *kernels(const Reference *r) {
#ifdef TWINBOX_AVX
    if (!r->scalar && sweeps_can(SWEEP_AVX2)) return &reference_avx2;
#endif
    (void)r;
    return &reference_scalar;
}

static bool solve(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, start);
    kernels(r)->run(r);
    reference_store(r, problem);
    return true;
}

bool reference_solve(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    r->aim = REFERENCE_TOLERANCE / 10;
    r->enough = REFERENCE_TOLERANCE / 4;
    r->most = INT_MAX;
    if (!solve(r, problem, start, error)) return false;
    r->residual = kernels(r)->residual(r);
    return true;
}

bool reference_solve_to(Reference *r, const ContactProblem *problem, double tolerance, int most, Error *error) {
    r->aim = r->enough = tolerance;
    r->most = most;
    if (!solve(r, problem, NULL, error)) return false;
    r->residual = r->best;
    return true;
}

void reference_round(const Reference *r, const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *velocity = &r->velocities[i];
        solution->velocities[i] = (BodyVelocity){vec2((float)velocity->x, (float)velocity->y), (float)velocity->spin};
    }
    for (int i = 0; i < problem->contact_count; i++)
        solution->impulses[i] = (ContactImpulse){(float)r->impulses[i].normal, (float)r->impulses[i].tangent};
}

bool reference_residual(Reference *r, const ContactProblem *problem, const ContactImpulse *impulses, double *residual,
                        Error *error) {
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, impulses);
    *residual = kernels(r)->residual(r);
    return true;
}
