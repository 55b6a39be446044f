/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network of contact points, beyond the paper. It predicts impulses, so every action has an equal reaction.

   The network sees each pair after the warm start, in the frame of its contact. For each contact point it predicts how
   far the impulse p = (normal, tangent) goes beyond the warm start p0, as a change d of the relative velocity. The
   result is projected onto the friction cone:

       p = P(p0 + d / (1/ma + 1/mb)),   P: pn' = max(pn, 0), pt' = clamp(pt, -mu pn', mu pn')

   Momentum and angular momentum are conserved by construction, and p is the warm start of the next step. Cone and
   accumulation are those of sequential impulses (Catto 2006). Fails on chains of boxes: all pairs are predicted from
   the same velocities, so an impulse travels one pair per step, and a box between two others is pushed twice. */
#include "solvers/pair_solver.h"
#include "solvers/solvers.h"

static const SettingSpec settings[] = {
    {"network", "file of a network with the target points (default: the scene's)"}, PAIR_SOLVER_NET, {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    PairSolver *solver = pair_solver_create("contact-net", chosen, error);
    if (solver == NULL || solver->network.target == TARGET_POINTS) return solver;
    error_input(error, settings_get(chosen, "network"),
                "the network has the target %s, which is for pair-net; contact-net needs the target points",
                pair_target_names[solver->network.target]);
    pair_solver_destroy(solver);
    return NULL;
}

const ContactSolverKind solver_contact_net = {
    .description = {.name = "contact-net",
                    .summary =
                        "beyond the paper: a network predicts impulses at contact points, clamped to the friction cone",
                    .caption = "neural network for contact points",
                    .look = {METHOD_WINE, METHOD_TRIANGLE},
                    .settings = settings,
                    .needs_network = true,
                    .twin = "contact-net:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
