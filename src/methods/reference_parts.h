/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's workspace and the parts of a solve. */
#pragma once
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/reference.h"
#include "methods/vec4.h"

#include <math.h>

/* A point strictly inside all bounds, or a change of one. u and w are kept beside l and t: as differences they would
   lose all digits where a contact slides. */
typedef struct ReferencePoint {
    Vec4 l, t; /* N s, normal and tangent impulse */
    Vec4 u, w; /* N s, mu l - t and mu l + t */
    Vec4 z;    /* m/s, normal velocity above the target */
    Vec4 p, q; /* m/s, sliding along +t (u is 0 at the solution) and -t (w is 0) */
} ReferencePoint;

/* Four contact slots. One without a contact has weight 0, rows of zeros, and ones in `now`. */
struct ReferenceGroup {
    Vec4 weight, mass_normal, mass_tangent, inverse_normal, inverse_tangent; /* kg and 1/kg, effective masses */
    Vec4 load_normal, load_tangent; /* kg, what the path measures impulses by */
    Vec4 friction;                  /* mu */
    BlockRows rows;
    Vec4 free_normal, free_tangent; /* m/s: velocities before the contacts along the rows; normal: minus the bias */
    Vec4 start_normal, start_tangent, normal, tangent, best_normal, best_tangent; /* N s, impulses inside the cone */
    Vec4 gap, slip;                       /* m/s: velocities along the rows, normal: minus the bias */
    ReferencePoint now;                   /* of the interior point */
    Vec4 missing_normal, missing_tangent; /* m/s: gap - z and slip - (q - p) */
    Vec4 over_z, dn, dt, s, rn, rt;       /* linear system, see reference_code.h */
    Vec4 wanted_n, wanted_p, wanted_q;    /* wanted changes of the products l z, u p, w q */
    ReferencePoint step, along;           /* directions */
};

/* Points that a solve may go back to: before it got stuck; before a step along the path. */
enum { KEPT_ON_WAY, KEPT_ON_PATH, KEPT };

/* Of `calm`: residuals from which a solve is finished with a few sweeps and steps; what such an answer misses does no
   harm. */
static const double near_solution = 1e-3;

static inline Vec4 clamp_between(Vec4 x, Vec4 limit) {
    const Vec4 low = larger4(x, -limit);
    return choose4((Mask4)(low < limit), low, limit);
}

/* The solve, and the residual of `normal` and `tangent`, compiled for several instruction sets with the same bits:
   reference_code.h. */
typedef struct ReferenceKernels {
    void (*run)(Reference *r);
    double (*residual)(Reference *r);
} ReferenceKernels;

extern const ReferenceKernels reference_scalar, reference_avx2;
