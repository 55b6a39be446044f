/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a dataset can be trained on as the options say. */
#pragma once
#include "training/training.h"

/* ERROR_INPUT: shapes, laws, or a network to go on from that do not fit; no rows to train on or to test on. */
bool training_check(const Dataset *dataset, const TrainingOptions *options, Error *error);
