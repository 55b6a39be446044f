/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Physical laws for one touching pair: the violation of each law by a change of the pair's velocities, and the gradient
   of the violation with respect to that change. The change of a static body is ignored.

       momentum  |ma dva + mb dvb|, N s: net momentum change; 0 if a body is static
       energy    increase of the pair's kinetic energy, J
       approach  approach velocity along the normal that remains at the mean contact point, m/s
       cone      distance of the pair's impulse J from Coulomb's friction cone, N s: max(0, |J.t| - mu max(J.n, 0))
                 along the tangent plus max(0, -J.n) for pulling. J is the impulse on b, or if b is static minus that
                 on a */
#pragma once
#include "pair/pair.h"
#include "pair/pair_context.h"

enum { LAW_MOMENTUM, LAW_ENERGY, LAW_APPROACH, LAW_CONE, LAWS };

/* A pair, prepared from its context. Arrays hold velocity (x, y) and spin of a, then of b. */
typedef struct LawPair {
    double mass[PAIR_CHANGES];     /* kg, kg m^2; 0 for a static body */
    double velocity[PAIR_CHANGES]; /* before the change */
    double approach[PAIR_CHANGES]; /* its dot product with velocities is the separation velocity along the normal */
    double normal[2], friction;
} LawPair;

LawPair law_pair(const float context[PAIR_CONTEXT]);

typedef struct Law {
    const char *name, *unit, *summary;
    /* Returns the violation, >= 0. slope[PAIR_CHANGES] is its gradient, valid if the violation is above 0. */
    double (*violation)(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]);
    /* The size of the change in the law's unit; normalises the violation (laws.h). */
    double (*size)(const LawPair *pair, const double change[PAIR_CHANGES]);
} Law;

extern const Law laws_known[LAWS];
