/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets allocations fail, also those of shared libraries: these functions replace the C library's in the program that
   includes this. Not under a sanitizer, which has its own; then none fails. allocations.h: only a program's own. */
#pragma once
#include "failing_allocations.h"
#include "sanitized.h"
#include "testing.h"

#ifndef SANITIZED
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);

void *malloc(size_t size) { return allocation_fails() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return allocation_fails() ? NULL : __libc_calloc(count, size); }
void *realloc(void *block, size_t size) { return allocation_fails() ? NULL : __libc_realloc(block, size); }
#endif

/* Calls `work`, which returns whether it was done, with each allocation failing once, and all from it on. Each time it
   is done or lacks memory. */
static inline void assert_memory_is_named(bool (*work)(Error *error)) {
    for (int rest = 0; rest < 2; rest++) {
        int failures = 0;
        failed_allocations = 1;
        for (int n = 1; failed_allocations > 0; n++) {
            Error error = {0};
            failed_allocations = 0;
            later_ones_fail = rest == 1;
            failing_allocation = n;
            const bool done = work(&error);
            failing_allocation = 0;
            failures += !done;
            if (!done) assert_error(error, ERROR_SYSTEM, "out of memory");
        }
#ifndef SANITIZED
        assert_true(failures > 0);
#endif
    }
}
