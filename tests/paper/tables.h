/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Made-up tables in a folder of the test. */
#pragma once
#include "testing.h"
#include "files.h"

static inline const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

static inline void write_text(const char *name, const char *text) {
    write_bytes(temporary_path(name), text, strlen(text));
}
