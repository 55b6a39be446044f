/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs many independent pieces of work on all threads (OpenMP). */
#pragma once
#include "common/error.h"
#include "common/progress.h"

typedef struct ParallelWork {
    /* Does piece i; called from several threads at once. False with error set stops the rest. */
    bool (*piece)(void *context, int i, Error *error);
    void *context;
} ParallelWork;

/* Does pieces 0 .. count - 1 in any order and reports each to progress. False with the first error, or with "what:
   error: stopped after ..." if progress requests a stop. */
bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error);
