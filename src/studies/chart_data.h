/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a chart of one scene: marks joined to lines, in two panels; and its caption. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "methods/methods.h"
#include "pictures/colours.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/statistics.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    CHART_MAX_LINES = 32,
    CHART_TEXT_SIZE = 128,
    CHART_PANELS = 2,
    CHART_LOUD = 6 /* lines in colour, at most */
};

/* How a line is drawn. */
typedef enum ChartRank {
    CHART_GREY,   /* thin and grey, its name in grey */
    CHART_HIDDEN, /* not: the silenced twin of a grey method, unless it is on the front */
    CHART_COLOURED
} ChartRank;

/* A method with its non-numeric settings ("engine:warm=off"). */
typedef struct ChartLine {
    char key[CHART_FAMILY_SIZE];          /* as in the table; identifies the line */
    char name[CHART_TEXT_SIZE];           /* plain, truncated */
    const char *method;                   /* as in the table, which outlives it */
    const MethodDescription *description; /* NULL: an unknown method */
    ChartRank rank;
    RunColours colours;
    bool asked;                        /* named by the reader */
    int marks[CHART_PANELS], left_out; /* numbers of marks drawn and left out */
    int lost;                          /* number of marks left out because the method lost the scene (chart_gather) */
    bool competes;                     /* or unknown; baselines and the reference do not */
    int beyond;                        /* number of marks left out because they are far from the coloured ones, and */
    double beyond_us[2], beyond_error[2]; /* their ranges, from least to most */
} ChartLine;

typedef struct ChartMark {
    int line;
    double us;    /* solver time per step, microseconds; of a program what it reports */
    double error; /* mean velocity error, m/s; at least chart_row_resolution() */
    bool floored; /* it was less, and PARETO_RESOLUTION is that */
    bool on_front;
    bool beaten;   /* another setting of its line beats it in both time and error */
    bool lost;     /* the method lost the scene; only of lines that are asked for */
    bool baseline; /* the run with the scene's own settings that the others are compared with */
    char
        label[CHART_TEXT_SIZE]; /* "k=20"; of several numeric settings those in which marks with the same keys differ */
    const char *method, *setting; /* as in the table, which outlives them */
} ChartMark;

typedef struct ChartPanel {
    int count;
    ChartMark *marks; /* [count], sorted by line, then by time; marks that are not drawn are not among them */
} ChartPanel;

typedef struct Chart {
    int line_count, launches;
    bool frozen; /* ChartLook */
    int floored; /* number of marks drawn at PARETO_RESOLUTION */
    ChartLine lines[CHART_MAX_LINES];
    ChartPanel panels[CHART_PANELS]; /* impact frames and the frames after */
    /* [front_count] the Pareto front by rising time, of all methods that compete and the reference */
    CurvePoint *front[CHART_PANELS];
    int front_count[CHART_PANELS];
    double floor[CHART_PANELS]; /* m/s: ChartRow.floor, where it is above PARETO_RESOLUTION, else 0 */
    double us_least, us_most, error_least, error_most; /* ranges of all marks */
    char times[CHART_TIMES_SIZE];                      /* chart_times_note(), of the whole table; plain */
} Chart;

/* Gathers a scene's rows. Lines keep their order in the table. Texts are restricted to letters, digits, spaces and
   -_.,:=+/()*[]; other characters become '?'. Left out and counted: rows without time or error, and rows of a method
   that let the boxes drift half a metre before the bomb came, as they were scored on another scene; of a line that the
   look highlights these are marks, too. Errors below chart_row_resolution() are drawn there. The axes show the coloured
   lines: other marks more than a decade away from them are left out, and counted in their line. At most CHART_LOUD
   lines are coloured: what the reader asks for, programs of others, the engine, interior, the strongest rival that
   learns nothing, scene-net, and the silenced twins of these. False with error set if nothing remains, or for more than
   CHART_MAX_LINES lines. */
bool chart_gather(Chart *chart, const CsvTable *table, const char *scene, const char *path, const ChartLook *look,
                  Error *error);
void chart_free(Chart *chart);

/* Whether a program of others takes its steps, by its own clock. */
bool chart_is_program(const ChartLine *line);

/* The word in its setting that switches its learned part off, "net=off"; NULL: it has none. */
const char *chart_twin_word(const ChartLine *line);

/* Whether each number in its setting is what the key's help calls the default. */
bool chart_mark_is_default(const ChartMark *mark);

/* Writes what the picture shows and what it leaves out. named[line]: whether the picture had room for its name. */
void chart_caption(const Chart *chart, const char *title, const bool *named, char *text, size_t size);

/* Replaces characters that names do not have (csv_plain_length), or that the font lacks, by '?'. */
void chart_make_plain(char *text);

/* Copies a text, made plain and truncated to fit. */
void chart_plain(char out[CHART_TEXT_SIZE], const char *text);
