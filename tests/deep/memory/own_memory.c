/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The memory sanitizer would take all memory that a library allocates and fills for uninitialised, as the library's
   stores are not seen. So only memory that twinbox itself allocates begins uninitialised: the linker hands its calls to
   the functions below, and the options leave the libraries' calls alone. */
#include <sanitizer/allocator_interface.h>
#include <sanitizer/msan_interface.h>
#include <stddef.h>

void *__real_malloc(size_t size);
void *__real_realloc(void *block, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void __wrap_free(void *block);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

const char *__msan_default_options(void);
const char *__msan_default_options(void) { return "poison_in_malloc=0:poison_in_free=0"; }

/* Uninitialised from `kept` on, allocated here. */
static void *uninitialised(void *block, size_t kept, size_t size) {
    if (block != NULL && size > kept) __msan_poison((char *)block + kept, size - kept);
    return block;
}

void *__wrap_malloc(size_t size) { return uninitialised(__real_malloc(size), 0, size); }

void *__wrap_realloc(void *block, size_t size) {
    size_t kept = block == NULL ? 0 : __sanitizer_get_allocated_size(block);
    return uninitialised(__real_realloc(block, size), kept, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
    return uninitialised(__real_aligned_alloc(alignment, size), 0, size);
}

/* A library may get this block next. */
void __wrap_free(void *block) {
    if (block != NULL) __msan_unpoison(block, __sanitizer_get_allocated_size(block));
    __real_free(block);
}
