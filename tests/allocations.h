/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts calls of malloc, calloc and realloc, and lets one fail. The linker hands those of a program, but not of shared
   libraries, to the functions below if tests/CMakeLists.txt lists it. */
#pragma once
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>

static int allocations, failed_allocations;
static int failing_allocation; /* the N-th from now on fails; 0: none */
static bool later_ones_fail;   /* too, until failing_allocation is set to 0 */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

static bool allocation_fails(void) {
    allocations++;
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

void *__wrap_malloc(size_t size) { return allocation_fails() ? NULL : __real_malloc(size); }

void *__wrap_calloc(size_t count, size_t size) { return allocation_fails() ? NULL : __real_calloc(count, size); }

void *__wrap_realloc(void *block, size_t size) { return allocation_fails() ? NULL : __real_realloc(block, size); }
