/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which allocation fails: for allocations.h and library_allocations.h. */
#pragma once
#include <errno.h>
#include <stdbool.h>

static int failing_allocation; /* the N-th from now on fails; 0: none */
static bool later_ones_fail;   /* too, until failing_allocation is set to 0 */
static int failed_allocations;

static inline bool allocation_fails(void) {
    if (failing_allocation == 0) return false;
    if (failing_allocation > 1) {
        failing_allocation--;
        return false;
    }
    if (!later_ones_fail) failing_allocation = 0;
    failed_allocations++;
    errno = ENOMEM;
    return true;
}
