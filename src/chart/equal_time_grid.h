/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The grid of scenes and methods that the figure of errors at equal time shows. */
#pragma once
#include "chart/chart_data.h"
#include "study/equal_time.h"

enum { EQUAL_TIME_COLUMNS = 40, EQUAL_TIME_SCENES = 64 };

typedef struct EqualTimeCell {
    bool ran;
    double ratio; /* EqualMethodRow; NaN: none */
} EqualTimeCell;

typedef struct EqualTimeGrid {
    int columns, rows;
    char time[CHART_TEXT_SIZE];                        /* setting of momentum whose time all methods have: "k=50" */
    char methods[EQUAL_TIME_COLUMNS][CHART_TEXT_SIZE]; /* plain */
    bool joined[EQUAL_TIME_COLUMNS]; /* the column and the one before it differ only in what was learned */
    char scenes[EQUAL_TIME_SCENES][CHART_TEXT_SIZE];
    char times[CHART_TIMES_SIZE]; /* chart_times_note(), plain; set by the caller */
    EqualTimeCell cells[EQUAL_TIME_SCENES][EQUAL_TIME_COLUMNS];
} EqualTimeGrid;

/* Learned methods stand beside their silenced twins. ERROR_INPUT with the path if the grid has no room. */
bool equal_time_grid(EqualTimeGrid *grid, const EqualTime *table, const char *path, Error *error);
