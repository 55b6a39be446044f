/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file may hold, and which solver takes it. */
#include "base/settings.h"
#include "pair_networks.h"

TEST(texts_that_do_not_fit_each_other_are_refused) {
    Network *network = network_sized(1, (const int[]){10, 3});
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    strcpy(network->target, "pair");
    assert_network_refused(&solver_pair_net, write_pair_network(network),
                           "the network has the inputs relative, the target pair and 3 outputs (); it needs outputs 2 "
                           "(dvx dvy) or 6 (dvxa dvya dwa dvxb dvyb dwb)");
    network = make_pair_network(PAIR_CONTACT, TARGET_PAIR, 2);
    strcpy(network->outputs, "dvx dvy");
    assert_network_refused(&solver_pair_net, write_pair_network(network),
                           "2 outputs (dvx dvy); it needs outputs 2 (dvn");
    network = make_pair_network(PAIR_RAW, TARGET_PAIR, 2);
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    assert_network_refused(&solver_pair_net, write_pair_network(network),
                           "the network has 12 inputs (dx dy vxa vya vxb vyb wa wb angle_a angle_b); it needs "
                           "those of relative (10), raw (12), raw-unturned (10), contact (20), neighbours (32)");
    network = make_pair_network(PAIR_RAW, TARGET_PAIR, 2);
    strcpy(network->target, "gross");
    assert_network_refused(&solver_pair_net, write_pair_network(network),
                           "'gross' is not a target of pair networks; known: pair, net, impulse, points");
    network = make_pair_network(PAIR_RELATIVE, TARGET_PAIR, 6);
    strcpy(network->target, "points");
    assert_network_refused(&solver_contact_net, write_pair_network(network),
                           "the target points and the inputs relative; it needs those of contact or neighbours");
    network = make_pair_network(PAIR_NEIGHBOURS, TARGET_PAIR, 6);
    strcpy(network->target, "impulse");
    assert_network_refused(&solver_pair_net, write_pair_network(network),
                           "the inputs neighbours, which change at every");
}

TEST(other_methods_networks_are_refused) {
    assert_network_refused(
        &solver_pair_net, constant_network(PAIR_CONTACT, TARGET_POINTS, 4, six),
        "the network has the target points, which is for contact-net; pair-net needs the target pair, ");
    assert_network_refused(&solver_pair_net, constant_network(PAIR_CONTACT, TARGET_IMPULSE, 2, six),
                           "which include accumulated impulses; pair-net has none");
    assert_network_refused(
        &solver_contact_net, constant_network(PAIR_RELATIVE, TARGET_NET, 6, six),
        "the network has the target net, which is for pair-net; contact-net needs the target points");
    assert_refused(solver_pair_net.create(&(Settings){0}, &error),
                   "pair-net: error: the scene names no network for it: use pair-net:network=FILE");
    assert_refused(solver_contact_net.create(&(Settings){0}, &error), "contact-net: error: the scene names no network");
}

RUN_TESTS(NULL, NULL)
