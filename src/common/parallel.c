/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/parallel.h"

#include <omp.h>
#include <stdatomic.h>

/* Threads without work would take processor time waiting. */
static int threads_for(int count) {
    int most = omp_get_max_threads();
    return count < 1 ? 1 : count < most ? count : most;
}

bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error) {
    atomic_int done = 0;
    atomic_bool stopped = false;
#pragma omp parallel for schedule(dynamic) num_threads(threads_for(count))
    for (int i = 0; i < count; i++) {
        if (atomic_load(&stopped)) continue;
        Error failure = {0};
        bool ok = work->piece(work->context, i, &failure);
#pragma omp critical
        {
            if (ok)
                ok = progress_report(progress, atomic_fetch_add(&done, 1) + 1, count);
            else if (error->kind == ERROR_NONE)
                *error = failure;
        }
        if (!ok) atomic_store(&stopped, true);
    }
    if (!atomic_load(&stopped)) return true;
    return error->kind == ERROR_NONE
               ? error_interrupted(error, what, "stopped after %d of %d", atomic_load(&done), count)
               : false;
}
