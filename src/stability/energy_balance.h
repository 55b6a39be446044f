/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy that the bodies of a run have, and how much of it is available to be lost. */
#pragma once
#include "dynamics/body.h"

/* Begin with energy_balance_begin(). */
typedef struct EnergyBalance {
    Vec2 gravity;
    double energy; /* J: mechanical energy of all dynamic bodies in the last frame */
    /* J: energy available to be lost, the larger of two.
       (a) The energy lost so far: the largest drop below the highest level before. Energy that an added body brings, or
       that pushing overlapping bodies apart adds, raises the level; energy of a removed body lowers it.
       (b) The potential energy of all dynamic bodies at the start, and of added ones: m |g| times the height above the
       lowest dynamic body at the start. So a standing stack has all its height to lose. */
    double available;
    double potential; /* J: (b) */
    double weight;    /* N: of all dynamic bodies at the start, and of added ones */
    double kinetic;   /* J: of all bodies at the start, and of added ones */
    double brought;   /* J: energy at the start and of added bodies; a removed body takes its share along */
    double lowest;    /* m: lowest height of a dynamic body at the start; INFINITY: no dynamic body so far */
    double level;     /* J: energy if none had been lost */
    int body_count;   /* in the last frame */
} EnergyBalance;

/* Begins with the bodies at the start. */
void energy_balance_begin(EnergyBalance *balance, Vec2 gravity, const Body *bodies, int count);

/* Adds a frame. Bodies may be appended, or the last ones removed, but not both in one step. */
void energy_balance_step(EnergyBalance *balance, const Body *bodies, int count);
