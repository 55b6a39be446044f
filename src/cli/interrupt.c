/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Signals. */
#include "base/base.h"
#include "base/machine.h"
#include "base/process.h"
#include "cli/interrupt.h"

#include <signal.h>
#include <stdatomic.h>
#include <unistd.h>

/* The handler and threads of parallel work use both: only lock-free atomics are defined there. */
static atomic_llong requested_at; /* ms since the machine started; 0: no request */
static atomic_int held;
_Static_assert(ATOMIC_LLONG_LOCK_FREE == 2 && ATOMIC_INT_LOCK_FREE == 2, "a signal handler may wait for a lock");

/* timeout(1) and schedulers send a signal to the process and then to its group: that is one request. */
enum { SAME_REQUEST = 1000 /* ms */ };

static void on_signal(int signal_number) {
    static const char text[] = "twinbox: error: interrupted\n";
    (void)signal_number;
    const long long now = (long long)(1000 * clock_seconds()); /* by a call that handlers may make */
    long long earlier = 0; /* two threads may be here at once: one of them is first */
    const bool first = atomic_compare_exchange_strong(&requested_at, &earlier, now);
    /* Not whether they are held now: the last words come after the release. */
    if (first ? atomic_load(&held) > 0 : now - earlier < SAME_REQUEST) return;
    const ssize_t ignored = write(STDERR_FILENO, text, sizeof text - 1);
    (void)ignored;
    talks_kill();
    _exit(ERROR_INTERRUPTED);
}

void interrupt_handle(void) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction hangup;
    if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) /* nohup(1) */
        sigaction(SIGHUP, &action, NULL);
}

void interrupt_hold(void) { atomic_fetch_add(&held, 1); }

void interrupt_release(void) { atomic_fetch_sub(&held, 1); }

bool interrupt_requested(void) { return atomic_load(&requested_at) != 0; }
