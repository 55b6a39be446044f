/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing plain arrays. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* Makes room for `wanted` items, more than there is room for, of `item_size` bytes in *items (a malloc'ed block or NULL,
   freed by the caller with free()), at least doubling, so that appending costs O(1). False when memory is short: *items
   is kept. */
bool array_grow(void **items, size_t *capacity, size_t wanted, size_t item_size);

/* The same where there may be room already. In place: steps of a few microseconds ask for a dozen arrays. */
static inline bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t item_size) {
    return wanted <= *capacity || array_grow(items, capacity, wanted, item_size);
}
