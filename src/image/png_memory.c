/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/png_memory.h"

#include <stdbool.h>
#include <stdlib.h>

png_voidp png_memory_take(png_structp png, png_alloc_size_t size) {
    void *block = malloc(size);
    if (block == NULL) *(bool *)png_get_mem_ptr(png) = true;
    return block;
}

void png_memory_release(png_structp png, png_voidp block) {
    (void)png;
    free(block);
}
