/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/energy_balance.h"

#include "study/world_measures.h"

#include <math.h>

/* m: height along the direction opposite to gravity. */
static double height(const Body *body, Vec2 gravity, double pull) {
    return -((double)body->position.x * gravity.x + (double)body->position.y * gravity.y) / pull;
}

/* Adds the potential energy of new bodies. The first dynamic bodies determine the lowest height. */
static void add_potential(EnergyBalance *balance, const Body *bodies, int count) {
    const Vec2 gravity = balance->gravity;
    double pull = vec2_distance(gravity, vec2(0, 0)), lowest = INFINITY;
    if (pull == 0) return;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0) lowest = fmin(lowest, height(&bodies[i], gravity, pull));
    if (isinf(balance->lowest)) balance->lowest = lowest;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        balance->potential += fmax(0, height(&bodies[i], gravity, pull) - balance->lowest) * pull / bodies[i].inv_mass;
        balance->weight += pull / bodies[i].inv_mass;
    }
    balance->available = fmax(balance->available, balance->potential);
}

void energy_balance_begin(EnergyBalance *balance, Vec2 gravity, const Body *bodies, int count) {
    *balance = (EnergyBalance){.gravity = gravity, .lowest = INFINITY, .body_count = count};
    balance->energy = balance->level = balance->brought = bodies_energy(bodies, count, gravity);
    balance->kinetic = bodies_energy(bodies, count, vec2(0, 0));
    add_potential(balance, bodies, count);
}

void energy_balance_step(EnergyBalance *balance, const Body *bodies, int count) {
    const int had = balance->body_count;
    double energy = bodies_energy(bodies, count, balance->gravity);
    if (count > had) {
        const double joined = bodies_energy(bodies + had, count - had, balance->gravity);
        balance->level += joined;
        balance->brought += joined;
        balance->kinetic += bodies_energy(bodies + had, count - had, vec2(0, 0));
        add_potential(balance, bodies + had, count - had);
    }
    /* The energy of removed bodies is no longer known: the step that removes them counts as one without losses. */
    if (count < had) {
        balance->level += energy - balance->energy;
        balance->brought += energy - balance->energy;
    }
    balance->level = fmax(balance->level, energy);
    balance->available = fmax(balance->available, balance->level - energy);
    balance->energy = energy;
    balance->body_count = count;
}
