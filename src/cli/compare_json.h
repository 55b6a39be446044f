/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of twinbox compare as JSON. */
#pragma once
#include "regression/regression.h"

/* What results.json of a report has. */
bool compare_json_pictures(const Regression *regression, Error *error);
bool compare_json_runs(const char *const paths[2], const Trajectory *a, const Trajectory *b,
                       const TrajectoryDifference *difference, Error *error);
