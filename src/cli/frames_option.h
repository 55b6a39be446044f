/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The option --frames A:B of commands that show runs. */
#pragma once
#include "cli/options.h"

typedef struct FrameRange {
    int first, last; /* inclusive; last -1: to the end */
} FrameRange;

/* "A:B", ":B", "A:" or "A"; `value` is a FrameRange. */
OptionRead frames_option_read;

/* Splits text at the first `separator` into two whole numbers. An empty part leaves its number unchanged. */
bool frames_option_split(const char *text, char separator, int minimum, int maximum, int64_t numbers[2]);
