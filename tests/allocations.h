/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts calls of malloc, calloc and realloc. The linker hands those of a program, but not of shared libraries, to the
   functions below if tests/CMakeLists.txt lists it. */
#pragma once
#include <stddef.h>

static int allocations;

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

void *__wrap_malloc(size_t size) { return allocations++, __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return allocations++, __real_calloc(count, size); }
void *__wrap_realloc(void *block, size_t size) { return allocations++, __real_realloc(block, size); }
