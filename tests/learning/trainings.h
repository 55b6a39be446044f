/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole trainings on shipped scenes, interrupted and continued. */
#pragma once
#include "made.h"

#include "base/machine.h"

/* Stops at the report of that number. */
static inline bool stop_at(void *context, double done, double total) {
    (void)done, (void)total;
    return --*(int *)context > 0;
}

/* What trains into its context, with the state at `path`; it frees what a stopped training leaves. */
typedef bool Train(void *context, const char *path, const Progress *progress, Error *error);

/* Trains until it is done, each time stopped some reports later than the last; returns how often it was interrupted. */
static inline int train_in_parts(Train *train, void *context, const char *path, int reports, int more) {
    for (int interrupted = 0;; interrupted++, reports += more) {
        assert_in_range(interrupted, 0, 50); /* or it never ends */
        int left = reports;
        Error error = {0};
        if (train(context, path, &(Progress){stop_at, &left}, &error)) return interrupted;
        assert_int_equal(error.kind, ERROR_INTERRUPTED);
        assert_int_equal(access(path, F_OK), 0);
    }
}
