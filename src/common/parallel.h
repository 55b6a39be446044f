/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many pieces of work, none of which needs another, by all threads (OpenMP). */
#pragma once
#include "common/error.h"
#include "common/progress.h"

typedef struct ParallelWork {
    /* Does piece i; called by several threads at once. False with error set stops the rest. */
    bool (*piece)(void *context, int i, Error *error);
    void *context;
} ParallelWork;

/* Does pieces 0 .. count - 1, in any order; progress hears of each that is done. False with the first error, or where
   progress asks to stop: "what: error: stopped after ...". */
bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error);
