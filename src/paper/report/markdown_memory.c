/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/markdown_memory.h"

#include <cmark-gfm-core-extensions.h>
#include <cmark-gfm.h>
#include <setjmp.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct Block {
    struct Block *next;
    size_t size;
    max_align_t data[];
} Block;

/* cmark-gfm's allocator has no context argument. */
static struct {
    jmp_buf full;
    Block *blocks;
    bool begun; /* the extensions, which stay, are registered */
    bool done;
} memory;

static void *take(size_t size) {
    Block *block = size < SIZE_MAX - sizeof *block ? calloc(1, sizeof *block + size) : NULL;
    if (block == NULL) longjmp(memory.full, 1);
    block->size = size;
    block->next = memory.blocks;
    memory.blocks = block;
    return block->data;
}

static void *take_zeros(size_t count, size_t size) {
    return take(size > 0 && count > SIZE_MAX / size ? SIZE_MAX : count * size);
}

static void *take_more(void *old, size_t size) {
    void *data = take(size);
    if (old == NULL) return data;
    const Block *block = (const Block *)((const char *)old - offsetof(Block, data));
    memcpy(data, old, block->size < size ? block->size : size);
    return data;
}

static void keep(void *data) { (void)data; }

static void free_blocks(void) {
    for (Block *block = memory.blocks, *next; block != NULL; block = next) {
        next = block->next;
        free(block);
    }
    memory.blocks = NULL;
}

bool markdown_memory_run(bool (*work)(void *context), void *context, Error *error) {
    cmark_mem *standard = cmark_get_default_mem_allocator();
    const cmark_mem before = *standard;
    *standard = (cmark_mem){take_zeros, take_more, keep};
    memory.begun = memory.done = false;
    if (setjmp(memory.full) == 0) {
        cmark_gfm_core_extensions_ensure_registered();
        memory.blocks = NULL;
        memory.begun = true;
        memory.done = work(context);
    } else {
        error_memory(error, "report");
    }
    *standard = before;
    if (memory.begun) free_blocks();
    return memory.done;
}
