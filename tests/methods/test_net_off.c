/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair_networks.h"

/* On every target's data net=off does what a network does that says their mean. */
TEST(without_its_network_a_method_says_what_the_data_were_on_average) {
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
        BodyVelocity silenced[3], network[3];
        ContactImpulse of_silenced[2], of_network[2];
        const char *text = printed("%s,net=off", constant_network(view, target, cases[i].outputs, six));
        solve_by(kind, text, 4, &chain, silenced, of_silenced);
        const char *path = constant_network(view, target, cases[i].outputs, twice);
        solve_by(kind, path, 4, &chain, network, of_network);
        assert_memory_equal(silenced, network, sizeof silenced);
        assert_memory_equal(of_silenced, of_network, sizeof of_silenced);
        assert_true(silenced[2].linear.y != 0);
    }
}

RUN_TESTS(NULL, NULL)
