/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares the states behind the pictures. Only regression.c and regression_frame.c include this. */
#pragma once
#include "regression/regression.h"

/* Finds and compares the .npz files of the same name in both folders. Ignores those that are a trajectory in neither
   folder; ERROR_INPUT if only one of the two is a trajectory. */
bool regression_find_runs(Regression *regression, Error *error);

/* Sets the states verdict of a frame. data: the two PNG files, whose texts are read. False with error set when memory is
   short. */
bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             Error *error);
