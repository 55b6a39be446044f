/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the states behind two pictures differ. Only regression.c includes this. */
#pragma once
#include "report/regression.h"

/* The trajectories that both folders have, compared. A file that is a trajectory in neither folder is passed over; one that
   is in one of them only is ERROR_INPUT. */
bool regression_find_runs(Regression *regression, Error *error);

/* Of two pictures in memory, with their texts. */
void regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES]);
