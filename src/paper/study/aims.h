/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the study is to reach. */
#pragma once
#include "pair/pair.h"

enum {
    PAPER_TARGETS = 3,  /* TARGET_PAIR, TARGET_NET, TARGET_IMPULSE: the readings of what the paper's networks predict */
    SMALL_NETWORK = 500 /* parameters, at most, of the networks that the aims for targets are for */
};

/* For each target: the highest test error, over the constant predictor's, that its best network may have; 0: no aim. */
extern const double target_aims[PAIR_TARGETS];
