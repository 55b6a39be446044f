/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/array.h"

#include <stdint.h>
#include <stdlib.h>

bool array_grow(void **items, size_t *capacity, size_t wanted, size_t item_size) {
    size_t room = *capacity < 8 ? 8 : *capacity;
    while (room < wanted) {
        if (room > SIZE_MAX / 2) return false;
        room *= 2;
    }
    if (room > SIZE_MAX / item_size) return false;
    void *grown = realloc(*items, room * item_size);
    if (grown == NULL) return false;
    *items = grown;
    *capacity = room;
    return true;
}
