/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a chart shows of a scene: marks joined to lines, in two panels. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>

enum {
    CHART_MAX_LINES = 24,
    CHART_TEXT_SIZE = 40,
    CHART_PANELS = 2,
    CHART_KEY_SIZE = CHART_NAME_SIZE + 2 * CHART_SETTING_SIZE
};

/* A method, with those of its settings that are words ("engine, warm=off"). */
typedef struct ChartLine {
    char key[CHART_KEY_SIZE];          /* whole, as the table has it: what tells lines apart */
    char name[CHART_TEXT_SIZE];        /* plain, and cut to fit */
    int marks[CHART_PANELS], left_out; /* how many */
    int lost;                          /* marks of a scene that was another before the bomb came (chart_gather) */
} ChartLine;

typedef struct ChartMark {
    int line;
    double us, us_q1, us_q3; /* time in the solver per step: median and quartiles, microseconds */
    double error;            /* mean, m/s */
    bool on_front;
    bool shipped;                /* with the setting that the method's description calls shipped */
    char label[CHART_TEXT_SIZE]; /* those of the settings that are numbers ("k=20"); or empty */
} ChartMark;

typedef struct ChartPanel {
    int count;
    ChartMark *marks; /* [count], by line, then by time */
} ChartPanel;

typedef struct Chart {
    int line_count, launches;
    int floored; /* marks drawn at PARETO_RESOLUTION */
    ChartLine lines[CHART_MAX_LINES];
    ChartPanel panels[CHART_PANELS];                   /* impact frames, frames after; closed loop */
    double us_least, us_most, error_least, error_most; /* of the marks */
} Chart;

/* Gathers a scene's rows. Lines keep the order, and so the looks, in which the whole table first names them. Texts
   are plain: letters, digits, spaces and -_.,:=+/()*[], anything else is '?', so no text can be more than a text to
   gnuplot. Left out and counted: rows without a time or an error, and those of a method which let the
   boxes drift half a metre before the bomb came: what it was scored on then is another scene. Errors that the
   reference cannot tell from 0 are drawn at PARETO_RESOLUTION (study/pareto.h). False with error set where nothing is
   left, or more than CHART_MAX_LINES lines. */
bool chart_gather(Chart *chart, const ChartTable *table, const char *scene, const char *path, Error *error);
void chart_free(Chart *chart);

/* The letter, or '?' in place of one that is not plain. */
char chart_plain_letter(char letter);

/* Copies a text, made plain and cut to fit. */
void chart_plain(char out[CHART_TEXT_SIZE], const char *text);
