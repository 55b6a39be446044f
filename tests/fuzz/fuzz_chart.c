/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a merge reads from the pieces of a chart: their results are bytes. */
#include "fuzz.h"

#include "studies/chart_table.h"
#include "studies/launch_scores.h"
#include "studies/scene_study.h"

#include <stdlib.h>

static void check_scores(const MethodScores *scores) {
    if (scores->unconverged < 0) fuzz_fail("%lld steps are not scored", (long long)scores->unconverged);
}

/* The first byte is the number of methods. */
void fuzz_scores(const uint8_t *data, size_t size) {
    Error error = {0};
    StoredScores stored;
    MethodScores scores = {0};
    if (size == 0) return;
    const int methods = data[0] % 8;
    fuzz_begin();
    bool ok = stored_scores_open(&stored, "launch", (const char *)data + 1, size - 1, methods, &error);
    for (int i = 0; ok && i < methods; i++) ok = method_scores_add(&scores, &stored, i, &error);
    fuzz_end(ok, &error, "launch");
    if (ok) check_scores(&scores);
    method_scores_free(&scores);
}

void fuzz_times(const uint8_t *data, size_t size) {
    Error error = {0};
    if (size == 0) return;
    const SceneStudy study = {.contender_count = data[0] % 8};
    MethodTimes *times =
        FUZZ_READ(scene_times_read(&study, "times", (const char *)data + 1, size - 1, &error), "times");
    for (int i = 0; times != NULL && i < study.contender_count; i++)
        if (times[i].costs[PROTOCOL_CLOSED][PHASE_REST].solver < 0) fuzz_fail("a time below 0");
    free(times);
}
