/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's network in place of constraint solving (Avatavului, Ifrim, Voncila 2023, sections 3.1 to 3.3).

   The network sees one pair of bodies at a time and predicts the change of their velocities, which is added to them.

   With two outputs it predicts the change of b's velocity relative to a's. The paper leaves open how the two bodies
   share this change and how their spins change. Here it is the effect of one impulse at the mean of the contact points,
   so momentum is conserved. With six outputs it predicts the change of both velocities and spins, added as it is:
   momentum is not conserved.

   The paper also leaves open which change the network is trained to predict, its target:

     pair     all pairs are predicted from the velocities before the solve, as in the training data; the order does not
              matter;
     net      the same, but each body takes the mean of the changes that its pairs predict: each is the body's whole
              change, so a sum would count it several times;
     impulse  k sweeps over the pairs, each predicted from the current velocities. The network has no warm start, so the
              sweeps begin from the velocities before the solve.

   momentum_error adds up the momentum that six outputs, or means of net changes, create, pair by pair and visit by
   visit. It counts even correct net changes, since parts of them come from other pairs.

   Fails on stacks: the network sees a single pair, so no impulse travels through a chain of boxes, and what remains of
   a velocity that should be zero adds up to sinking. With inputs in the frame of the contact, its warm starts are 0 in
   its own runs, since it returns no impulses, but those of the engine in its training data. */
#include "solvers/pair_solver.h"
#include "solvers/solvers.h"

static const SettingSpec settings[] = {
    {"network", "file of the trained network (default: the scene's)"},
    {"k", "sweeps over all pairs per step, for the target impulse (default: the scene's, else 10)"},
    PAIR_SOLVER_NET,
    {NULL, NULL}};

static bool check(const PairNetwork *network, const char *path, Error *error) {
    if (network->target == TARGET_POINTS)
        return error_input(
            error, path,
            "the network has the target points, which is for contact-net; pair-net needs the target pair, "
            "net or impulse");
    if (network->target == TARGET_IMPULSE && pair_views[network->view].by_contact)
        return error_input(error, path,
                           "the network has the target impulse and the inputs %s, which include accumulated impulses; "
                           "pair-net has none",
                           pair_views[network->view].name);
    return true;
}

static void *create(const Settings *chosen, Error *error) {
    PairSolver *solver = pair_solver_create("pair-net", chosen, error);
    if (solver == NULL || check(&solver->network, settings_get(chosen, "network"), error)) return solver;
    pair_solver_destroy(solver);
    return NULL;
}

const ContactSolverKind solver_pair_net = {
    .description = {.name = "pair-net",
                    .summary = "the paper's network: predicts the change of velocities, pair by pair",
                    .caption = "neural network for pairs",
                    .look = {METHOD_ORANGE, METHOD_DIAMOND},
                    .settings = settings,
                    .needs_network = true,
                    .twin = "pair-net:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
