/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fewer launches to train on, the same to test on. */
#pragma once
#include "dataset/dataset.h"

/* A copy with the rows of the launches to train on for which keep[launches] is true, and of all that are held out.
   Launches keep their numbers: those left out are still listed, but have no rows. ERROR_INPUT where nothing would be left
   to train on. */
Dataset *dataset_subset(const Dataset *dataset, const bool *keep, Error *error);

/* The same with `count` launches to train on, of those that have rows, drawn with the seed: with the same seed more
   launches contain fewer. ERROR_INPUT where there are not so many. */
Dataset *dataset_draw_subset(const Dataset *dataset, int count, uint64_t seed, Error *error);
