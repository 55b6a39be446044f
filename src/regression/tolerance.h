/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a picture may differ and still pass. Nothing given: every pixel must be equal. */
#pragma once
#include "image/flip.h"
#include "image/image_compare.h"

/* Bits of Tolerance.given. */
typedef enum ToleranceLimit {
    LIMIT_FUZZY = 1 << 0,
    LIMIT_TOLERANCE = 1 << 1,
    LIMIT_BEYOND = 1 << 2,
    LIMIT_FLIP_MEAN = 1 << 3,
    LIMIT_FLIP_P99 = 1 << 4,
    LIMIT_ANTIALIAS = 1 << 5,
    LIMITS_FLIP = LIMIT_FLIP_MEAN | LIMIT_FLIP_P99
} ToleranceLimit;

/* All that is given must hold. Members that are not given are 0. */
typedef struct Tolerance {
    unsigned given;
    int fuzzy;                  /* largest difference of a channel, 0..255 */
    double share;               /* largest share of pixels that differ, 0..1; given with fuzzy */
    int tolerance;              /* pixels that differ by at most this, 0..255, count as equal */
    double beyond;              /* largest share of pixels that differ by more than `tolerance` */
    double flip_mean, flip_p99; /* largest FLIP: mean, 99th percentile (image/flip.h) */
    bool antialias;             /* ignore pixels along edges (image/antialias.h) */
} Tolerance;

/* Replaces in *tolerance what `over` gives. */
void tolerance_override(Tolerance *tolerance, const Tolerance *over);

/* Whether the pictures pass. `flip` is used only if a limit of FLIP is given. */
bool tolerance_holds(const Tolerance *tolerance, const ImageDifference *difference, const FlipSummary *flip);

/* "differences of at most 2 in at most 1% of the pixels, FLIP of at most 0.01 on average"; "none". */
typedef struct ToleranceText {
    char text[320];
} ToleranceText;
ToleranceText tolerance_words(const Tolerance *tolerance);

/* "MAX", "mean=MAX" or "p99=MAX", with MAX from 0 to 1. False, and nothing set, for anything else. */
bool tolerance_parse_flip(Tolerance *tolerance, const char *text);
