/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the study set out to reach. */
#pragma once

enum {
    PAPER_TARGETS = 3,  /* TARGET_PAIR, TARGET_NET, TARGET_IMPULSE: the readings of what the paper's networks predict */
    SMALL_NETWORK = 500 /* parameters: the aims for targets are for networks with at most so many */
};
