/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress reports of long work. The library never prints: cli/ supplies the bar. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct Progress {
    /* Called repeatedly, never from two threads at once; returns false to stop the work early. */
    bool (*report)(void *context, double done, double total);
    void *context;
} Progress;

/* True to continue; always true for a NULL progress. */
static inline bool progress_report(const Progress *progress, double done, double total) {
    return progress == NULL || progress->report(progress->context, done, total);
}

/* A stage of longer work: it covers `share` of the whole, from `begin` on. The context of a Progress whose function is
   progress_stage. */
typedef struct ProgressStage {
    const Progress *whole; /* may be NULL */
    double begin, share;   /* 0 to 1 */
    bool stopped;          /* a stop was requested; `whole` is not called again */
} ProgressStage;

static inline bool progress_stage(void *context, double done, double total) {
    ProgressStage *stage = (ProgressStage *)context;
    stage->stopped = stage->stopped || !progress_report(stage->whole, stage->begin + stage->share * done / total, 1);
    return !stage->stopped;
}
