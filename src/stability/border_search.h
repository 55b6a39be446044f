/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where along a number a method holds, and where it fails: every border between the two.

   The range is scanned coarsely; every change between neighbours is bisected down to the resolution. Both sides of what is
   found, and the next value outward of each, are asked with other seeds, starts that differ by next to nothing. Where
   they do not agree luck decides: such a value is no side of a border, and the next one outward is looked for that all
   seeds agree upon. So an interval wider than the resolution is one in which luck decides. What changes and changes back
   within a step of the scan is seen next to a border only. */
#pragma once
#include "stability/verdict.h"

enum { BORDER_SEEDS = 3, BORDERS_MAX = 32, BORDER_POINTS_MAX = 64 };

/* Resolution: whole numbers 1, linear 1/100 of the range, logarithmic a factor of 1.05 (whole numbers: at least 1). */
typedef struct BorderScan {
    double from, to; /* from < to; logarithmic: from > 0 */
    int points;      /* 2 .. BORDER_POINTS_MAX, with both ends */
    bool logarithmic, whole;
    bool fails_low; /* expected to fail at low values: the order in which borders are listed */
} BorderScan;

typedef struct BorderProbe {
    /* The verdict at a value; seed 0 .. BORDER_SEEDS - 1. */
    bool (*ask)(void *context, double value, int seed, Verdict *verdict, Error *error);
    void *context;
    int seeds; /* to be asked: 1 .. BORDER_SEEDS */
} BorderProbe;

typedef struct Border {
    double holds_at, fails_at; /* neighbours, or NAN: there is none */
    Verdict verdict;           /* how it fails there, the worst of the seeds */
} Border;

/* Never empty. Without a border it has one entry. All holds: holds_at is the last value, the verdict the worst found. All
   fails: fails_at is the first value, and its verdict. Where luck decides up to the end, a last entry has the last
   value that holds, and how it fails beyond; NAN on both sides where luck decides over all. */
typedef struct BorderList {
    int count;
    Border items[BORDERS_MAX]; /* from where it is expected to hold to where it is expected to fail */
} BorderList;

/* The values of the coarse scan, ascending, each once: of 4 digits, so that a table names the very number that was run.
   Returns how many. */
int border_scan_values(const BorderScan *scan, double values[BORDER_POINTS_MAX]);

/* False with error set where a question fails, memory is short or there are more borders than the list takes. */
bool border_search(BorderList *list, const BorderScan *scan, const BorderProbe *probe, Error *error);
