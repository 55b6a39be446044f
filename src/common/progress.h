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
