/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a page that plays runs carries (src/pictures/player_internal.h). */
#pragma once
#include "files.h"
#include "owned.h"

#include <libdeflate.h>

/* Digits of base 91, up to a '<', as bytes in their place. Returns how many. */
static inline size_t read_digits(char *text) {
    size_t size = 0;
    uint32_t bits = 0;
    int count = 0;
    for (const char *next = text; *next != '<';) {
        uint32_t group = 0;
        int digits = 0;
        for (; digits < 2 && *next != '<'; next++)
            group += (digits++ == 0 ? 1 : 91) * (uint32_t)((*next == '#' ? '<' : *next) - '$');
        bits |= group << count;
        for (count += digits == 2 ? 13 : 6; count >= 8; count -= 8, bits >>= 8) text[size++] = (char)bits;
    }
    return size;
}

/* The JSON of a page in a file. */
static inline char *page_data(const char *path) {
    enum { MOST = 1 << 20 };
    FREED char *page = text_of(path);
    char *packed = strstr(page, "id=\"data\">"), *data = calloc(MOST, 1);
    struct libdeflate_decompressor *reader = libdeflate_alloc_decompressor();
    assert_true(packed != NULL && data != NULL && reader != NULL);
    packed += strlen("id=\"data\">");
    const size_t size = read_digits(packed);
    size_t used = 0;
    assert_int_equal(libdeflate_deflate_decompress(reader, packed, size, data, MOST - 1, &used), LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(reader);
    return data;
}
