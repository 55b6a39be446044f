/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's network in place of constraint solving (Avatavului, Ifrim, Voncila 2023, sections 3.1 to 3.3).

   Pair by pair, numbers of the two bodies go in, and the change of their velocities comes out, to be added. Two outputs
   give the change of b's velocity relative to a's. The paper leaves open how it is shared and what becomes of the
   spins; here it is the impulse that makes this change, acting at the middle of the contact points, so that momentum is
   kept. Six outputs give the change of both velocities and spins, added as it is: momentum is not kept. What was asked
   of the network, which the paper leaves open too, says when:

     pair     all pairs see the velocities before the solve, as in the training data: their order does not matter;
     net      the same, and each body takes the mean over its pairs of what they say. All of them say the same change:
              a sum would count it several times;
     impulse  k sweeps over the pairs, each from the velocities that those before it left. The network knows no warm
              start, so they begin from the velocities before the solve.

   The momentum that six outputs or shares of net changes make from nothing is counted pair by pair, and visit by visit
   (momentum_error). Of net changes even the right ones count: a pair's two bodies owe theirs to other pairs too.

   Fails on stacks: it sees one pair and no other, so no impulse can be carried through a chain of boxes; and what
   it leaves of a velocity that should be zero adds up to sinking. Seen from the contact, it also meets warm starts of 0
   in its own run, for it gives no impulses, where its training data had the engine's. */
#include "solvers/pair_solver.h"
#include "solvers/solvers.h"

static const SettingSpec settings[] = {
    {"network", "file of the trained network (the scene's own)"},
    {"k", "sweeps over all pairs a step, for a network of single impulses (the scene's own: 10)"},
    {NULL, NULL}};

static bool check(const PairNetwork *network, const char *path, Error *error) {
    if (network->target == TARGET_POINTS)
        return error_input(error, path,
                           "a network of the target points, which are contact-net's; pair-net needs one of "
                           "the target pair, net or impulse");
    if (network->target == TARGET_IMPULSE && pair_views[network->view].by_contact)
        return error_input(error, path,
                           "a network of the target impulse with the inputs %s: it needs the impulses so far at the "
                           "points, which pair-net does not know",
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
                    .summary = "the paper's network: the change of a pair's velocities, pair by pair",
                    .settings = settings,
                    .title = "Neural network",
                    .needs_network = true},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
