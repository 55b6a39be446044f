/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds all borders along a parameter: the values where a method changes from holding to failing.

   A coarse scan finds changes between neighbouring values, bisection narrows each to the resolution. Both sides of a
   border and their outward neighbours are repeated with other seeds, which shift the start by a tiny amount. A value
   for which the seeds disagree is undecided; it cannot be a side of a border, so the search moves outward to the next
   value on which all seeds agree. A border wider than the resolution thus encloses undecided values. A change and its
   reversal within one step of the scan are found only next to a border. */
#pragma once
#include "stability/verdict.h"

enum { BORDER_SEEDS = 3, BORDERS_MAX = 32, BORDER_POINTS_MAX = 128 };

/* Resolution: linear 1/100 of the range, logarithmic a factor of 1.05; at least 1 for whole numbers. */
typedef struct BorderScan {
    double from, to; /* from < to; logarithmic: from > 0 */
    int points;      /* 2 .. BORDER_POINTS_MAX, including both ends */
    bool logarithmic, whole;
    bool fails_low; /* expected to fail at low values; reverses the order of the list */
    bool either;    /* fails_low is set if the lowest value of the coarse scan fails and the highest holds */
} BorderScan;

typedef struct BorderProbe {
    /* The verdict at a value; seed 0 .. BORDER_SEEDS - 1. */
    bool (*evaluate)(void *context, double value, int seed, Verdict *verdict, Error *error);
    void *context;
    int seeds; /* to evaluate: 1 .. BORDER_SEEDS */
} BorderProbe;

typedef struct Border {
    double holds_at, fails_at; /* neighbouring values, or NaN */
    Verdict verdict;           /* at fails_at, the worst of the seeds */
} Border;

/* Never empty. Without a border it has one entry: if all values hold, holds_at is the last value and the verdict the
   worst found; if all fail, fails_at is the first value. If the values up to the end are undecided, the last entry has
   the last value that holds, fails_at = NaN and the worst verdict beyond it. If all values are undecided, both are
   NaN. */
typedef struct BorderList {
    int count;
    Border items[BORDERS_MAX]; /* ordered from the end expected to hold to the end expected to fail */
} BorderList;

/* The distinct values of the coarse scan, ascending, rounded to 4 digits so that tables show exactly the value that was
   run. Returns their number. */
int border_scan_values(const BorderScan *scan, double values[BORDER_POINTS_MAX]);

/* False with error set if an evaluation fails, memory is short or there are more than BORDERS_MAX borders. */
bool border_search(BorderList *list, const BorderScan *scan, const BorderProbe *probe, Error *error);
