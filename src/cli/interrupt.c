/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/interrupt.h"

#include "common/error.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

/* The handler and threads of parallel work use both: only lock-free atomics are defined there. */
static atomic_bool requested;
static atomic_int held;
_Static_assert(ATOMIC_BOOL_LOCK_FREE == 2 && ATOMIC_INT_LOCK_FREE == 2, "a signal handler may wait for a lock");

static void on_signal(int signal_number) {
    static const char text[] = "twinbox: error: interrupted\n";
    (void)signal_number;
    if (!atomic_exchange(&requested, true) && atomic_load(&held) > 0) return;
    const ssize_t ignored = write(STDERR_FILENO, text, sizeof text - 1);
    (void)ignored;
    _exit(ERROR_INTERRUPTED);
}

void interrupt_handle(void) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void interrupt_hold(void) { atomic_fetch_add(&held, 1); }

void interrupt_release(void) { atomic_fetch_sub(&held, 1); }

bool interrupt_requested(void) { return atomic_load(&requested); }

void interrupt_forget(void) { atomic_store(&requested, false); }
