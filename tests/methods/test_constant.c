/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair_networks.h"

/* On every target's data the constant does what a network does that says their mean. */
TEST(the_constant_says_what_the_data_were_on_average) {
    const float twice[PAIR_CHANGES] = {2, 4, 6, 8, 10, 12};
    const struct {
        PairView view;
        PairTarget target;
        int outputs;
    } cases[] = {
        {PAIR_RELATIVE, TARGET_PAIR, 6},  {PAIR_RAW, TARGET_PAIR, 2},       {PAIR_CONTACT, TARGET_PAIR, 2},
        {PAIR_CONTACT, TARGET_NET, 6},    {PAIR_RELATIVE, TARGET_NET, 2},   {PAIR_RAW, TARGET_IMPULSE, 6},
        {PAIR_CONTACT, TARGET_POINTS, 4}, {PAIR_NEIGHBOURS, TARGET_NET, 2}, {PAIR_NEIGHBOURS, TARGET_POINTS, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const PairView view = cases[i].view;
        const PairTarget target = cases[i].target;
        const ContactSolverKind *kind = target == TARGET_POINTS ? &solver_contact_net : &solver_pair_net;
        BodyVelocity constant[3], network[3];
        ContactImpulse of_constant[2], of_network[2];
        const char *path = constant_network(view, target, cases[i].outputs, six);
        solve_by(&solver_constant, path, 4, &chain, constant, of_constant);
        path = constant_network(view, target, cases[i].outputs, twice);
        solve_by(kind, path, 4, &chain, network, of_network);
        assert_memory_equal(constant, network, sizeof constant);
        assert_memory_equal(of_constant, of_network, sizeof of_constant);
        assert_true(constant[2].linear.y != 0);
    }
    /* It sees nothing, so it may say what pair-net cannot ask for. */
    BodyVelocity v[3];
    ContactImpulse impulses[2];
    solve_by(&solver_constant, constant_network(PAIR_CONTACT, TARGET_IMPULSE, 6, six), 4, &chain, v, impulses);
    assert_near(v[2].linear.y, 4 * 2 * 4, 1e-5); /* normal (0, 1): 4 sweeps of the mean, twice 4 along the normal */
}

TEST(a_silenced_network_is_the_constant) {
    static const PairTarget targets[] = {TARGET_POINTS, TARGET_PAIR};
    for (int i = 0; i < 2; i++) {
        char text[512];
        BodyVelocity constant[3], silenced[3], network[3];
        ContactImpulse impulses[2];
        const ContactSolverKind *kind = targets[i] == TARGET_POINTS ? &solver_contact_net : &solver_pair_net;
        const char *path = constant_network(PAIR_CONTACT, targets[i], targets[i] == TARGET_POINTS ? 4 : 2, six);
        solve_by(&solver_constant, path, 4, &chain, constant, impulses);
        solve_by(kind, path, 4, &chain, network, impulses);
        snprintf(text, sizeof text, "network=%s,net=off", path);
        ContactSolver solver = make_solver(kind, text);
        ContactSolution solution = {silenced, impulses, 0, {0}};
        assert_ok(solver.kind->solve(solver.state, &chain, &solution, &error), error);
        assert_memory_equal(silenced, constant, sizeof constant);
        assert_memory_not_equal(silenced, network, sizeof network);
        free_solver(&solver);
    }
}

RUN_TESTS(NULL, NULL)
