/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points with a sparse direct solve over the bodies (interior/block_lu.h), run to the end.

   1. Two sweeps of projected Gauss-Seidel from the warm start. If the contact states they lead to (open, sticking,
      sliding) are those of a solution, a linear solve finds it (reference_active.c): nearly always at rest.
   2. Else the central path is followed to the solution (reference_path.c), also where it turns back (reference_arc.c).
   3. If the path is lost, again from another distance.

   The solution of 1 is the one that the sweeps lead to; that of 2 is the end of the central path, which does not depend
   on the start. */
#include "reference/reference_parts.h"

enum { START_SWEEPS = 2, MOST = 200, ATTEMPTS = 6, CARELESS = 3 };

/* Distances of the start from its bounds, times its residual. The last attempts follow the path by its length. */
static const double scales[ATTEMPTS] = {3, 30, 300, 30, 300, 3};
static const double look_ahead[] = {1e3, 1e6, 1e9}, near_solution = 1e-5; /* m/s */

static void keep_start(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].start_normal = r->groups[i].normal;
        r->groups[i].start_tangent = r->groups[i].tangent;
    }
}

void reference_keep_best(Reference *r, double miss) {
    if (!(miss < r->best)) return;
    r->best = miss;
    for (int i = 0; i < r->group_count; i++) {
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

/* Near the solution the states of most contacts are clear. */
static bool finish(Reference *r) {
    const double enough = REFERENCE_TOLERANCE / 2;
    const int count = sizeof look_ahead / sizeof *look_ahead;
    for (int i = 0; i < count && r->best > enough && r->best < near_solution; i++) {
        take_best(r);
        reference_keep_best(r, reference_polish(r, REFERENCE_TOLERANCE / 10, look_ahead[i]));
    }
    return r->best <= enough;
}

static void run(Reference *r) {
    for (int i = 0; i < START_SWEEPS; i++) reference_sweep(r);
    reference_apply(r);
    keep_start(r);
    r->best = INFINITY;
    reference_keep_best(r, reference_miss(r, NULL));
    reference_keep_best(r, reference_polish(r, REFERENCE_TOLERANCE / 10, 1));
    bool solved = r->best <= REFERENCE_TOLERANCE / 10;
    for (; !solved && r->attempts < ATTEMPTS; r->attempts++) {
        reference_begin(r, scales[r->attempts]);
        solved = reference_follow(r, MOST, r->attempts >= CARELESS) || finish(r);
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
