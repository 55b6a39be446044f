/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of speed against accuracy, drawn from chart.csv. */
#pragma once
#include "base/base.h"
#include "pictures/colours.h"
#include "studies/chart_table.h"

#include <stdbool.h>

/* 174 x 92 mm, two columns of a paper; 85 x 144 mm, one column, a panel above the other; 160 x 90 mm, 16:9. */
typedef enum ChartSize { CHART_PAGE, CHART_COLUMN, CHART_SLIDE } ChartSize;

typedef struct ChartLook {
    ChartSize size;
    const char *highlight; /* methods to be drawn in colour, separated by commas; NULL: none beside the usual ones */
    bool chosen;           /* all lines are: methods that --methods names, but silenced twins */
    bool frozen;           /* errors and times on recorded steps, which methods that lose the scene have, too */
    bool words;            /* the caption below the picture, too, which makes it higher */
    ColourChoices colours; /* those that name a line count */
} ChartLook;

/* ERROR_INPUT if a choice names no line of the charts of these rows, of which method and setting count, or has a colour
   that is refused (pictures/colours.h). */
bool chart_colours_check(const ColourChoices *choices, const ChartRow *rows, int count, Error *error);

/* Whether rows of the table have each name of the list, at most as many as there are colours. ERROR_INPUT otherwise. */
bool chart_highlight_check(const char *highlight, const ChartRow *rows, int count, Error *error);

/* Draws folder/chart-SCENE.png, .svg and .pdf from the table at csv_path, and writes what they show as chart-SCENE.txt.
   x: solver time per step; y: mean velocity error; both logarithmic. Two panels: impact frames and the 60 frames after,
   in closed loop. At most six methods are in colour, each named at its curve; all others are grey. What no method
   reaches is shaded (the Pareto front, studies/statistics.h); dotted lines are the time and the error of the engine
   with the scene's own sweeps. The folder must exist. ERROR_INPUT for an invalid table, a scene without marks, or a
   scene name that is not a file name. Each file appears complete or not at all. */
bool chart_plot(const char *csv_path, const char *scene, const char *folder, const ChartLook *look, Error *error);
