/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison as CI systems show them: a list of test cases, the frames, then the trajectories. */
#pragma once
#include "regression/regression.h"

#include <limits.h>

typedef struct RegressionCase {
    const char *kind; /* "frames" or "trajectories" */
    const char *name, *verdict;
    bool failed;
    RegressionText words;
    char paths[SIDES][PATH_MAX]; /* of the files; "" where there is none, or if it is too long */
    double seconds;
    const RegressionFrame *frame; /* NULL for a trajectory */
} RegressionCase;

int regression_case_count(const Regression *regression);
RegressionCase regression_case(const Regression *regression, int i);
