/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The second form of hybrid's learning: beside the memory a network of scene-net makes one training step for each step that
   becomes an entry, on that step alone (network/slot_network.h, impact_training/slot_loss.h). Its slots and projections are
   those of the first entries. Source: Robbins, Monro, "A Stochastic Approximation Method" (1951), with Adam. */
#pragma once
#include "common/error.h"
#include "dynamics/contact_problem.h"

#include <stdint.h>

enum { ONLINE_FIRST = 300 }; /* entries that make the network; it trains on the next ones */

typedef struct OnlineNet OnlineNet;

OnlineNet *online_net_create(uint64_t seed, Error *error);
void online_net_destroy(OnlineNet *net);

/* Learns a step, which is copied. *seconds: processor time of the training step. *wrong: RMS velocity error of the network and its sweeps on it before that, m/s; NAN while
   there is no network. False with error set when memory is short, or if a weight becomes NaN or infinite. */
bool online_net_learn(OnlineNet *net, const ContactProblem *problem, double *wrong, double *seconds, Error *error);
