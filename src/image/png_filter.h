/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row filters of PNG (specification, section 9). */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* row[bytes] = the row that `filtered`, a filter's number and `bytes` bytes, stands for. above[bytes]: the row above,
   zeros for the first. step: 1 to 4, bytes per pixel. No two of the arrays overlap. False for an unknown filter. */
bool png_unfilter(const uint8_t *filtered, const uint8_t *above, size_t bytes, int step, uint8_t *row);
