/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's workspace and the parts of a solve. */
#pragma once
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/reference.h"

#include <math.h>

enum { REFERENCE_SLOTS = 4, REFERENCE_PAIRS = 2 };

/* A point strictly inside all bounds, or a change of one. u and w are kept beside l and t: as differences they would
   lose all digits where a contact slides. */
typedef struct ReferencePoint {
    Vec4 l, t; /* N s, normal and tangent impulse */
    Vec4 u, w; /* N s, mu l - t and mu l + t */
    Vec4 z;    /* m/s, normal velocity above the target */
    Vec4 p, q; /* m/s, sliding along +t (u is 0 at the solution) and -t (w is 0) */
} ReferencePoint;

/* Four contacts: two of each of two pairs. A slot without a contact has weight 0, rows of zeros, and ones in `now`. */
struct ReferenceGroup {
    Vec4 weight, mass_normal, mass_tangent, inverse_normal, inverse_tangent; /* kg and 1/kg, effective masses */
    Vec4 friction;                                                           /* mu */
    Vec4 normal_x, normal_y; /* the rows, as those of the pairs; the tangent is (normal_y, -normal_x) */
    Vec4 normal_b, normal_a, tangent_b, tangent_a; /* m, of the spins of b and a */
    Vec4 free_normal, free_tangent; /* m/s: velocities before the contacts along the rows; normal: minus the bias */
    Vec4 start_normal, start_tangent, normal, tangent, best_normal, best_tangent; /* N s, impulses inside the cone */
    Vec4 gap, slip;                       /* m/s: velocities along the rows, normal: minus the bias */
    ReferencePoint now;                   /* of the interior point */
    Vec4 missing_normal, missing_tangent; /* m/s: gap - z and slip - (q - p) */
    Vec4 over_z, dn, dt, s, rn, rt;       /* linear system, see methods/reference_newton.h */
    Vec4 wanted_n, wanted_p, wanted_q;    /* wanted changes of the products l z, u p, w q */
    ReferencePoint step, along;           /* directions */
};

/* Rows of a pair's slots in the coordinates (linear velocity of b minus that of a, spin of b, spin of a). */
struct ReferencePair {
    Vec4 normal[2], tangent[2];
    int32_t a, b;     /* positions of the bodies in the elimination; `count` for a body that does not move */
    BlockPlace place; /* of the blocks that couple them */
    int first, count; /* contacts in the problem */
};

/* Points that a solve may go back to: before it got stuck; before a step along the path. */
enum { KEPT_ON_WAY, KEPT_ON_PATH, KEPT };

static inline Vec4 reference_all(double x) { return (Vec4){x, x, x, x}; }
static inline double reference_sum(Vec4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

typedef long long ReferenceMask __attribute__((vector_size(32), aligned(16), may_alias));
static inline Vec4 reference_choose(ReferenceMask mask, Vec4 x, Vec4 y) {
    return (Vec4)((mask & (ReferenceMask)x) | (~mask & (ReferenceMask)y));
}
static inline Vec4 reference_larger(Vec4 x, Vec4 y) { return reference_choose((ReferenceMask)(x > y), x, y); }
static inline Vec4 reference_clamp(Vec4 x, Vec4 limit) {
    const Vec4 low = reference_larger(x, -limit);
    return reference_choose((ReferenceMask)(low < limit), low, limit);
}

/* methods/reference_point.c: the problem; then the warm start or the given impulses as `normal` and `tangent`. */
bool reference_load(Reference *r, const ContactProblem *problem);
void reference_start(Reference *r, const ContactProblem *problem, const ContactImpulse *start);
void reference_store(Reference *r, const ContactProblem *problem);

/* The solve, and the residual of `normal` and `tangent`, compiled for several instruction sets with the same bits:
   methods/reference_code.h. */
typedef struct ReferenceKernels {
    void (*run)(Reference *r);
    double (*residual)(Reference *r);
} ReferenceKernels;

extern const ReferenceKernels reference_scalar, reference_avx2;
