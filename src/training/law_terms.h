/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of physics for one touching pair: how far a change of its velocities breaks each of them, and the slope of
   that by each number of the change. A static body takes no part, whatever is said to happen to it.

       momentum  |ma dva + mb dvb|, N s: two bodies only push each other, so what one gains the other loses. A static
                 body takes any momentum: 0 there
       energy    J by which the kinetic energy of the pair rises: contacts have no springs
       approach  m/s at which the middle of the contact points is still approached along the normal
       cone      N s by which the pair's impulse J leaves Coulomb's cone: max(0, |J.t| - mu max(J.n, 0)) across, and
                 max(0, -J.n) pulling. J is what b was given, or where b is static what a gave */
#pragma once
#include "pair/pair.h"
#include "pair/pair_context.h"

enum { LAW_MOMENTUM, LAW_ENERGY, LAW_APPROACH, LAW_CONE, LAWS };

/* A pair, prepared from its context. The numbers of a change: velocity, spin of a, then of b. */
typedef struct LawPair {
    double mass[PAIR_CHANGES];     /* kg, kg m^2: inertia that each number of the change moves; 0 for a static body */
    double velocity[PAIR_CHANGES]; /* before */
    double approach[PAIR_CHANGES]; /* its sum with velocities is how fast the bodies part along the normal */
    double normal[2], friction;
} LawPair;

LawPair law_pair(const float context[PAIR_CONTEXT]);

typedef struct Law {
    const char *name, *unit, *summary;
    /* How far the change breaks the law, >= 0; slope[PAIR_CHANGES] of that, where it is above 0. */
    double (*violation)(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]);
    /* What the violation is compared with: how much of its kind the change makes. */
    double (*size)(const LawPair *pair, const double change[PAIR_CHANGES]);
} Law;

extern const Law laws_known[LAWS];
