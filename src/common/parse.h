/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers from text, for scene files and options. The whole text must be a number: no locale, no surrounding space, no
   NaN, no infinity. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* A decimal number, rounded to the nearest float32, or a fraction of two such as 1/60, divided in float32. */
bool parse_float(const char *text, float *value);

/* A decimal number in the range of float32, rounded to the nearest double. */
bool parse_double(const char *text, double *value);

/* The decimal number that text begins with, as parse_double reads it; *rest is what follows it. */
bool parse_leading_double(const char *text, double *value, const char **rest);

bool parse_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value);

/* "A:B:STEP", three floats with STEP > 0 and A <= B. Value i of the range is the decimal A + i * STEP (computed
   in double, then rounded to float32, so that -5:5:0.05 gives the floats of the decimals -5.00, -4.95, ...). */
typedef struct FloatRange {
    double first, step;
    int count;
} FloatRange;
bool parse_range(const char *text, int max_count, FloatRange *range);
float range_value(const FloatRange *range, int i);
