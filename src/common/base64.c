/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base64.h"

#include <stdint.h>

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void put_group(const uint8_t *bytes, size_t left, char *to) {
    uint32_t group = (uint32_t)bytes[0] << 16;
    if (left > 1) group |= (uint32_t)bytes[1] << 8;
    if (left > 2) group |= bytes[2];
    to[0] = digits[group >> 18];
    to[1] = digits[group >> 12 & 63];
    to[2] = left > 1 ? digits[group >> 6 & 63] : '=';
    to[3] = left > 2 ? digits[group & 63] : '=';
}

void base64_put(FILE *file, const void *data, size_t size) {
    char text[4096];
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3, used += 4) {
        if (used == sizeof text) {
            fwrite(text, 1, used, file); /* an error stays in the file, for the caller */
            used = 0;
        }
        put_group((const uint8_t *)data + i, size - i, text + used);
    }
    fwrite(text, 1, used, file);
}
