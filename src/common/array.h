/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing plain arrays. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* Makes room for `wanted` items of `item_size` bytes in *items (a malloc'ed block or NULL, freed by the caller
   with free()), at least doubling, so that appending costs O(1). False when memory is short: *items is kept. */
bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t item_size);
