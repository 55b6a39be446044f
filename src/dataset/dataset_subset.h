/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subsets of the training launches, with the same held-out launches. */
#pragma once
#include "dataset/dataset.h"

/* A copy with the rows of all held-out launches and of the training launches for which keep[launches] is true. Launches
   keep their numbers: those left out remain listed without rows. ERROR_INPUT if no training rows remain. */
Dataset *dataset_subset(const Dataset *dataset, const bool *keep, Error *error);

/* The same with `count` training launches drawn from those with rows. With the same seed, a larger subset contains a
   smaller one. ERROR_INPUT if there are not enough. */
Dataset *dataset_draw_subset(const Dataset *dataset, int count, uint64_t seed, Error *error);
