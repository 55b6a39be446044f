/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays that grow. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* Grows *items (a malloc'ed block or NULL, freed by the caller) to `wanted` items of `item_size` bytes; `wanted`
   exceeds the capacity. The capacity at least doubles, so that appending costs O(1). False when memory is short; *items
   stays valid. */
bool array_grow(void **items, size_t *capacity, size_t wanted, size_t item_size);

/* The same, but does nothing if the capacity suffices. Inline: a step of a few microseconds reserves a dozen arrays. */
static inline bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t item_size) {
    return wanted <= *capacity || array_grow(items, capacity, wanted, item_size);
}
