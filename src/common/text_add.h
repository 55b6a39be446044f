/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text that grows in a fixed array. */
#pragma once
#include "common/error.h"

#include <stddef.h>

/* Appends as printf does; what does not fit is cut off. */
void text_add(char *text, size_t size, const char *format, ...) PRINTF_LIKE(3, 4);

/* The ending of a noun: "1 frame", "2 frames". */
static inline const char *plural(int count) { return count == 1 ? "" : "s"; }
