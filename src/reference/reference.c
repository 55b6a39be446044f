/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points with a sparse direct solve over the bodies (interior/block_lu.h), run to the end.

   1. Two sweeps of projected Gauss-Seidel from the warm start. If the contact states they lead to (open, sticking,
      sliding) are those of a solution, a linear solve finds it (reference_active.c): nearly always at rest.
   2. Else the central path is followed to the solution (reference_path.c), also where it turns back (reference_arc.c).
   3. If the path is lost, again from another distance.

   The solution of 1 is the one that the sweeps lead to; that of 2 is the end of the central path, which does not depend
   on the start. */
#include "reference/reference_parts.h"

enum { START_SWEEPS = 2, MOST = 200 };

/* Distances of the start from its bounds, times its residual. */
static const double scales[] = {3, 30, 0.3, 300};

static void keep_start(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].start_normal = r->groups[i].normal;
        r->groups[i].start_tangent = r->groups[i].tangent;
        r->groups[i].best_normal = r->groups[i].normal;
        r->groups[i].best_tangent = r->groups[i].tangent;
    }
}

static void take_best(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].normal = r->groups[i].best_normal;
        r->groups[i].tangent = r->groups[i].best_tangent;
    }
    reference_apply(r);
}

static void run(Reference *r) {
    const int scale_count = (int)(sizeof scales / sizeof *scales);
    for (int i = 0; i < START_SWEEPS; i++) reference_sweep(r);
    reference_apply(r);
    keep_start(r);
    if (reference_polish(r, REFERENCE_TOLERANCE / 10) <= REFERENCE_TOLERANCE / 10) return;
    r->best = INFINITY;
    for (bool solved = false; !solved && r->attempts < scale_count; r->attempts++) {
        reference_begin(r, scales[r->attempts]);
        solved = reference_follow(r, MOST);
    }
    take_best(r);
}

bool reference_solve(Reference *r, const ContactProblem *problem, const ContactImpulse *start, Error *error) {
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, start);
    reference_apply(r);
    run(r);
    reference_store(r, problem);
    r->residual = reference_sweep(r);
    return true;
}

bool reference_residual(Reference *r, const ContactProblem *problem, const ContactImpulse *impulses, double *residual,
                        Error *error) {
    if (!reference_load(r, problem)) return error_memory(error, "reference");
    reference_start(r, problem, impulses);
    reference_apply(r);
    *residual = reference_sweep(r);
    return true;
}
