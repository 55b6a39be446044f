/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network of contact points, beyond the paper: its outputs are impulses, so what one body gains the other loses.

   All pairs see the moment after the warm start, each in the frame of its contact. For each of its points the network
   says how far the impulse p = (normal, tangent) should go beyond the warm start p0, as a change d of the relative
   velocity; what comes of it is projected on the friction cone:

       p = P(p0 + d / (1/ma + 1/mb)),   P: pn' = max(pn, 0), pt' = clamp(pt, -mu pn', mu pn')

   Momentum and angular momentum are kept by construction, and p is the next step's warm start. The cone and the
   accumulation are those of sequential impulses (Catto 2006). Fails on a chain: all pairs act at once on what they saw
   before, so an impulse gets one link further a step, and what is pushed from both sides is pushed twice. */
#include "solvers/pair_solver.h"
#include "solvers/solvers.h"

static const SettingSpec settings[] = {{"network", "file of the trained network of points (the scene's own)"},
                                       {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    PairSolver *solver = pair_solver_create("contact-net", chosen, error);
    if (solver == NULL || solver->network.target == TARGET_POINTS) return solver;
    error_input(error, settings_get(chosen, "network"),
                "a network of the target %s, which is pair-net's; contact-net needs one of the target points",
                pair_target_names[solver->network.target]);
    pair_solver_destroy(solver);
    return NULL;
}

const ContactSolverKind solver_contact_net = {
    .description = {.name = "contact-net",
                    .summary = "beyond the paper: a network's impulses at the contact points, inside the friction cone",
                    .settings = settings,
                    .needs_network = true},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
