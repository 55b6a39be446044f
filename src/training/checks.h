/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Validates training options against a dataset. */
#pragma once
#include "training/training.h"

/* ERROR_INPUT: layer widths, laws or a start network that do not match the dataset; no training rows or no test
   rows. */
bool training_check(const Dataset *dataset, const TrainingOptions *options, Error *error);
