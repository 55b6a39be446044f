/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The principal directions of a memory's keys. */
#pragma once
#include "tabulation/tabulation.h"

/* others: [count, memory->numbers] numbers of the bodies but the bomb in `count` > 0 steps. Sets the memory's centre to
   their mean and its rows to their strongest directions. False with error set when memory is short, or if a number is not
   finite. */
bool key_fit(Tabulation *memory, const float *others, int count, uint64_t seed, Error *error);
