/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/caption_check.h"

#include "picture/caption_size.h"
#include "type/type_check.h"

#include <string.h>

bool caption_check(const char *text, const char *where, Error *error) {
    if (text != NULL && strlen(text) >= CAPTION_SIZE)
        return error_input(error, where, "the text has %zu bytes, but at most %d are allowed", strlen(text),
                           CAPTION_SIZE - 1);
    return type_check(text, where, error);
}
