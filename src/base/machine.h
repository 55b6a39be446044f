/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work on this machine: its progress, all threads, a second thread, clocks, processor and memory.

     bool piece(void *context, int i, Error *error);
     parallel_for(&(ParallelWork){piece, context}, count, "launches", progress, &error) */
#pragma once
#include "base/base.h"

/* Progress reports of long work. The library never prints: cli/ supplies the bar. */

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

/* The next stage begins where this one ends. */
static inline void progress_next_stage(ProgressStage *stage, double share) {
    stage->begin += stage->share;
    stage->share = share;
}

/* Runs many independent pieces of work on all threads (OpenMP). */

typedef struct ParallelWork {
    /* Does piece i; called from several threads at once. False with error set stops those behind it. */
    bool (*piece)(void *context, int i, Error *error);
    void *context;
} ParallelWork;

/* Does pieces 0 .. count - 1 in any order and reports each to progress. False with the error of the least piece that
   fails, for any number of threads, or with "what: error: stopped after ..." if progress requests a stop. */
bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error);

/* A second thread that works on one item after the other, in the order in which they are given, while the caller makes
   the next. */

typedef struct Background Background;

/* Called in the second thread. After a failure it is not called again. */
typedef bool BackgroundWork(void *context, void *item, Error *error);

Background *background_start(BackgroundWork *work, void *context, Error *error);

/* Waits until the item before is done, then gives the next. False with the error of an earlier item: then it is not
   taken. The item must last until the next call returns. */
bool background_give(Background *background, void *item, Error *error);

/* Waits until all items are done; with the first error. */
bool background_wait(Background *background, Error *error);

/* Ends the thread when its item is done. */
void background_stop(Background *background);

/* Seconds of a clock that never steps back. */
double clock_seconds(void);

/* The processor's model, as the system names it, in plain characters of ASCII: "Intel(R) Xeon(R) CPU @ 2.20GHz"; else
   the architecture. */
enum { CPU_NAME_SIZE = 96 };
void cpu_name(char name[CPU_NAME_SIZE]);

/* The limit that a shell or a service sets on the memory of a process: the likely reason where a library fails without
   giving one. */

typedef struct MemoryLimit {
    char text[80]; /* "; the memory of a process is limited to 200 MiB (ulimit -v)"; empty without a limit */
} MemoryLimit;

MemoryLimit memory_limit(void);
