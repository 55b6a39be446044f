/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long work tells how far it is. The library never prints: cli/ supplies the bar. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct Progress {
    /* Called every now and then, never from two threads at once; returns false to ask the work to stop early. */
    bool (*report)(void *context, double done, double total);
    void *context;
} Progress;

/* True to go on. A NULL progress always goes on. */
static inline bool progress_report(const Progress *progress, double done, double total) {
    return progress == NULL || progress->report(progress->context, done, total);
}

/* Part of a longer work: what is done of it counts for `share` of the whole, from `begin` on. Used as the context of a
   Progress that reports by progress_stage. */
typedef struct ProgressStage {
    const Progress *whole; /* may be NULL */
    double begin, share;   /* 0 to 1 */
    bool stopped;          /* it was asked to, and is not asked again */
} ProgressStage;

static inline bool progress_stage(void *context, double done, double total) {
    ProgressStage *stage = (ProgressStage *)context;
    stage->stopped = stage->stopped || !progress_report(stage->whole, stage->begin + stage->share * done / total, 1);
    return !stage->stopped;
}
