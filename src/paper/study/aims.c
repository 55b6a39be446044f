/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/aims.h"

const double target_aims[PAIR_TARGETS] = {[TARGET_PAIR] = 0.4, [TARGET_NET] = 0.4, [TARGET_IMPULSE] = 0.1};
