/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Allocations. */
#define _GNU_SOURCE
#include "shim.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* dlsym may allocate while it looks for the function that allocates. What it gets then is never freed. */
static void *early(size_t size) {
    static _Alignas(16) char arena[4096];
    static size_t used;
    used = (used + 15) & ~(size_t)15;
    if (size > sizeof arena - used) return NULL;
    used += size;
    return arena + used - size;
}

#define REAL_OR_EARLY(function, size)                  \
    static __typeof__(function) *real;                 \
    static bool looking;                               \
    if (real == NULL) {                                \
        if (looking) return early(size);               \
        looking = true;                                \
        *(void **)&real = dlsym(RTLD_NEXT, #function); \
    }

void *malloc(size_t size) {
    REAL_OR_EARLY(malloc, size)
    return FAILS(CALL_MALLOC) ? NULL : real(size);
}

void *calloc(size_t count, size_t size) {
    REAL_OR_EARLY(calloc, count * size)
    return FAILS(CALL_MALLOC) ? NULL : real(count, size);
}

void *realloc(void *old, size_t size) {
    REAL(realloc);
    return FAILS(CALL_MALLOC) ? NULL : real(old, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    REAL(aligned_alloc);
    return FAILS(CALL_MALLOC) ? NULL : real(alignment, size);
}

/* The C library's own copies allocate, which must not count again. */
char *strdup(const char *text) {
    REAL(strdup);
    if (FAILS(CALL_MALLOC)) return NULL;
    const bool before = shim_enter();
    char *copy = real(text);
    shim_leave(before);
    return copy;
}

char *strndup(const char *text, size_t size) {
    REAL(strndup);
    if (FAILS(CALL_MALLOC)) return NULL;
    const bool before = shim_enter();
    char *copy = real(text, size);
    shim_leave(before);
    return copy;
}
