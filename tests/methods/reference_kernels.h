/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's vectorised linear systems against the scalar ones. */
#pragma once
#include "testing.h"

#include "methods/reference.h"

/* Reused from call to call, to test data that earlier problems leave. plain.scalar must be set. */
typedef struct ReferenceKernels {
    Reference lanes, plain;
} ReferenceKernels;

static inline void reference_kernels_free(ReferenceKernels *kernels) {
    reference_free(&kernels->lanes);
    reference_free(&kernels->plain);
}

/* Fails where any bit of a solve differs. */
static inline void assert_reference_kernels_agree(ReferenceKernels *kernels, const ContactProblem *problem) {
    Error error = {0};
    Reference *lanes = &kernels->lanes, *plain = &kernels->plain;
    assert_true(plain->scalar && !lanes->scalar);
    assert_ok(reference_solve(lanes, problem, NULL, &error), error);
    assert_ok(reference_solve(plain, problem, NULL, &error), error);
    assert_int_equal(lanes->factorizations, plain->factorizations);
    assert_memory_equal(&lanes->residual, &plain->residual, sizeof lanes->residual);
    assert_memory_equal(lanes->velocities, plain->velocities, (size_t)problem->body_count * sizeof *lanes->velocities);
    assert_memory_equal(lanes->impulses, plain->impulses, (size_t)problem->contact_count * sizeof *lanes->impulses);
}
