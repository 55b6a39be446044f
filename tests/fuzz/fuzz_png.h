/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files that reach behind their checksums. */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* Sets the checksums of all chunks that a file has whole, so that a reader looks at what they hold. */
void png_repair(uint8_t *file, size_t size);
