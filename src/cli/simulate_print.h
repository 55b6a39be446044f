/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What `simulate` prints: the run in a line, or with --json as an object (src/trajectory/README.md). */
#pragma once
#include "cli/simulate_verdict.h"

typedef struct SimulateResult {
    const Scene *scene;
    const char *method, *output; /* output: NULL if no run is written */
    int bodies;
    uint64_t state; /* hash of the last frame */
    NetworkFallbacks fallbacks;
    SimulateVerdict verdict;
    bool judged; /* there is a verdict */
} SimulateResult;

/* Prints all but the verdict. */
void simulate_result_print(const SimulateResult *result);

bool simulate_result_json(const SimulateResult *result, Error *error);
