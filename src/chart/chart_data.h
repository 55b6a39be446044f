/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a chart of one scene: marks joined to lines, in two panels. */
#pragma once
#include "sketch/plot_style.h"
#include "study/chart_rows.h"

#include <stdbool.h>

enum {
    CHART_MAX_LINES = 32,
    CHART_TEXT_SIZE = 40,
    CHART_PANELS = 2,
    CHART_KEY_SIZE = CHART_NAME_SIZE + sizeof ":near," + 2 * CHART_SETTING_SIZE
};

/* A method with its non-numeric settings ("engine:warm=off"). Runs with a stopping rule ("engine:near") are a line of
   their own beside those with a fixed number of sweeps. */
typedef struct ChartLine {
    char key[CHART_KEY_SIZE];          /* as in the table; identifies the line */
    char name[CHART_TEXT_SIZE];        /* plain, truncated */
    int marks[CHART_PANELS], left_out; /* numbers of marks drawn and left out */
    int lost;                          /* number of marks left out because the method lost the scene (chart_gather) */
    bool no_push_out;                  /* as in the method's description */
    bool competes;                     /* or unknown; baselines and the reference do not */
    int beyond;                        /* number of marks left out because they are far from all that compete, and */
    double beyond_us[2], beyond_error[2]; /* their ranges, from least to most */
    PlotStyle style;
} ChartLine;

typedef struct ChartMark {
    int line;
    double us, us_q1, us_q3; /* solver time per step: median and quartiles, microseconds */
    double error;            /* mean velocity error, m/s; at least PARETO_RESOLUTION */
    bool floored;            /* it was less */
    bool on_front;
    bool shipped;                 /* the setting that the method's description calls shipped */
    char label[CHART_TEXT_SIZE];  /* numeric settings ("k=20"); or empty */
    const char *method, *setting; /* as in the table, which outlives them */
} ChartMark;

typedef struct ChartPanel {
    int count;
    ChartMark *marks; /* [count], sorted by line, then by time */
} ChartPanel;

typedef struct Chart {
    int line_count, launches;
    int floored; /* number of marks drawn at PARETO_RESOLUTION */
    ChartLine lines[CHART_MAX_LINES];
    ChartPanel panels[CHART_PANELS];                   /* impact frames and the frames after; closed loop */
    double us_least, us_most, error_least, error_most; /* ranges of all marks */
    char times[CHART_TIMES_SIZE];                      /* chart_times_note(), of the whole table; plain */
} Chart;

/* Gathers a scene's rows. Lines keep their order in the table. Texts are restricted to
   letters, digits, spaces and -_.,:=+/()*[]; other characters become '?'.
   Left out and counted: rows without time or error, and rows of a method that let the boxes drift half a metre
   before the bomb came, as they were scored on another scene. Errors below PARETO_RESOLUTION (study/pareto.h) are drawn
   there. The axes show the methods that compete: marks of baselines and of the reference more than a decade away from
   them are left out, and counted in their line. False with error set if nothing remains, or for more than
   CHART_MAX_LINES lines. */
bool chart_gather(Chart *chart, const ChartTable *table, const char *scene, const char *path, Error *error);
void chart_free(Chart *chart);

/* Replaces characters that names do not have (csv_plain_length), or that the font lacks, by '?'. */
void chart_make_plain(char *text);

/* Copies a text, made plain and truncated to fit. */
void chart_plain(char out[CHART_TEXT_SIZE], const char *text);
