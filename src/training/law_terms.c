/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "training/law_terms.h"

#include <math.h>
#include <string.h>

static double inertia(float inverse) { return inverse > 0 ? 1 / (double)inverse : 0; }

/* The normal velocity of a body's point at `arm`, as weights of the body's velocity and spin. */
static void set_approach(double approach[3], double sign, const double normal[2], const float arm[2]) {
    approach[0] = sign * normal[0];
    approach[1] = sign * normal[1];
    approach[2] = sign * ((double)arm[0] * normal[1] - (double)arm[1] * normal[0]);
}

LawPair law_pair(const float context[PAIR_CONTEXT]) {
    LawPair pair = {.normal = {(double)context[CONTEXT_NORMAL], (double)context[CONTEXT_NORMAL + 1]},
                    .friction = (double)context[CONTEXT_FRICTION]};
    pair.mass[0] = pair.mass[1] = inertia(context[CONTEXT_INV_MASS_A]);
    pair.mass[2] = inertia(context[CONTEXT_INV_INERTIA_A]);
    pair.mass[3] = pair.mass[4] = inertia(context[CONTEXT_INV_MASS_B]);
    pair.mass[5] = inertia(context[CONTEXT_INV_INERTIA_B]);
    for (int k = 0; k < PAIR_CHANGES; k++) pair.velocity[k] = (double)context[CONTEXT_VELOCITIES + k];
    if (pair.mass[0] > 0) set_approach(pair.approach, -1, pair.normal, context + CONTEXT_ARM_A);
    if (pair.mass[3] > 0) set_approach(pair.approach + 3, 1, pair.normal, context + CONTEXT_ARM_B);
    return pair;
}

/* The pair's impulse J is computed from one dynamic body's velocity change: its first index, and the factor of J. */
static int impulse_body(const LawPair *pair) { return pair->mass[3] > 0 ? 3 : 0; }
static double impulse_mass(const LawPair *pair) { return pair->mass[3] > 0 ? pair->mass[3] : -pair->mass[0]; }

static double impulse_size(const LawPair *pair, const double change[PAIR_CHANGES]) {
    const double *given = change + impulse_body(pair);
    return fabs(impulse_mass(pair)) * sqrt(given[0] * given[0] + given[1] * given[1]);
}

static double momentum_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    const double a = pair->mass[0], b = pair->mass[3];
    memset(slope, 0, PAIR_CHANGES * sizeof *slope);
    if (a == 0 || b == 0) return 0;
    const double x = a * change[0] + b * change[3], y = a * change[1] + b * change[4], size = sqrt(x * x + y * y);
    if (size == 0) return 0;
    slope[0] = a * x / size, slope[1] = a * y / size;
    slope[3] = b * x / size, slope[4] = b * y / size;
    return size;
}

static double energy_change(const LawPair *pair, const double change[PAIR_CHANGES]) {
    double rise = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) rise += pair->mass[k] * change[k] * (pair->velocity[k] + change[k] / 2);
    return rise;
}

static double energy_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    for (int k = 0; k < PAIR_CHANGES; k++) slope[k] = pair->mass[k] * (pair->velocity[k] + change[k]);
    return fmax(0, energy_change(pair, change));
}

static double approach_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    double parting = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) {
        parting += pair->approach[k] * (pair->velocity[k] + change[k]);
        slope[k] = -pair->approach[k];
    }
    return fmax(0, -parting);
}

static double approach_size(const LawPair *pair, const double change[PAIR_CHANGES]) {
    double sum = 0;
    for (int k = 0; k < PAIR_CHANGES; k++) sum += pair->approach[k] * change[k];
    return sum;
}

static double cone_violation(const LawPair *pair, const double change[PAIR_CHANGES], double slope[PAIR_CHANGES]) {
    const double n[2] = {pair->normal[0], pair->normal[1]}, t[2] = {n[1], -n[0]}, mass = impulse_mass(pair);
    const double *given = change + impulse_body(pair);
    double *by_given = slope + impulse_body(pair);
    const double along = mass * (given[0] * n[0] + given[1] * n[1]),
                 across = mass * (given[0] * t[0] + given[1] * t[1]);
    const double side = across < 0 ? -1 : 1, outside = fabs(across) - pair->friction * fmax(along, 0);
    memset(slope, 0, PAIR_CHANGES * sizeof *slope);
    for (int i = 0; i < 2; i++) {
        if (outside > 0) by_given[i] += mass * side * t[i];
        if (outside > 0 && along > 0) by_given[i] -= mass * pair->friction * n[i];
        if (along < 0) by_given[i] -= mass * n[i];
    }
    return fmax(0, outside) + fmax(0, -along);
}

const Law laws_known[LAWS] = {
    [LAW_MOMENTUM] = {"momentum", "N s", "the pair's momentum is conserved", momentum_violation, impulse_size},
    [LAW_ENERGY] = {"energy", "J", "the pair's kinetic energy does not increase", energy_violation, energy_change},
    [LAW_APPROACH] = {"approach", "m/s", "the bodies no longer approach", approach_violation, approach_size},
    [LAW_CONE] = {"cone", "N s", "the impulse pushes and is within Coulomb's friction cone", cone_violation,
                  impulse_size}};
