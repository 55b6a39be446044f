/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors at equal time: each method beside its best rival, as tables and as a figure. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/statistics.h"

#include <stdbool.h>

typedef struct EqualTimeFigure {
    bool drawn; /* false if no method has a rival: there are tables only */
    NameList left_out;
} EqualTimeFigure;

/* Reads a chart.csv and writes folder/equal_time.csv and equal_time_methods.csv, and the latter as a figure,
   folder/equal_time.png, .svg and .pdf with their caption, .txt: a row for each scene, a column for each method, in
   each cell its error as a ratio to that of its best rival in the same time. Methods and scenes without any ratio are
   left out, and named there. */
bool equal_time_plot(const char *chart_csv, const char *folder, EqualTimeFigure *figure, Error *error);

/* The families of a chart, each with its curve of error over time in one scene.

   A family is a method with the words of its setting ("engine:warm=off"); its settings differ in numbers. The rivals of
   a method are the families of other methods that learn nothing; a learned method's silenced twin is no rival of it.
   The best rival at a time is the one with the least error in that time. Closed loop only. Baselines, the reference and
   rows without time or error are left out; a setting that lost the scene is on no curve. Errors below
   REFERENCE_TOLERANCE count as that. */

typedef enum CurveStatistic { CURVE_MEAN, CURVE_MEDIAN, CURVE_P95 } CurveStatistic;

enum { CURVE_STATISTICS = CURVE_P95 + 1 };

typedef struct CurveFamily {
    char name[CHART_FAMILY_SIZE], method[CHART_NAME_SIZE];
    const MethodDescription *description; /* NULL: an unknown method */
} CurveFamily;

typedef struct RivalCurves {
    int family_count;
    CurveFamily *families; /* [family_count], in the order of their first rows; grows from scene to scene */
    int count;             /* rows of the scene that count, */
    const ChartRow **rows; /* [count] */
    int *family;           /* [count] index into families */
    bool *lost;            /* [count] */
    CurvePoint *points;    /* scratch, [count] */
} RivalCurves;

typedef struct BestRival {
    int family;       /* -1: no rival has a setting as quick */
    double error;     /* m/s; NAN without a rival */
    CurveReach reach; /* CURVE_BEFORE without a rival */
} BestRival;

/* Every method's error next to the error that its best rival has in the same time: equal_time.csv for
   each setting at the time that it takes, equal_time_methods.csv for each method at one time for all in a scene. */

/* Whose error is below chart_row_resolution(). Where both are, their ratio says nothing about what a run looks like. */
typedef enum ErrorsBelow { BELOW_NONE, BELOW_METHOD, BELOW_RIVAL, BELOW_BOTH } ErrorsBelow;

typedef struct EqualTimeRow {
    const char *scene, *method, *setting;
    Phase phase; /* PHASE_IMPACT or PHASE_AFTER */
    CurveStatistic statistic;
    int launches;
    double us_solver, error; /* microseconds, m/s; over all scored steps of all launches */
    const char *rival;       /* family of the best rival; "": none */
    CurveReach reach;        /* where the time lies on the rival's curve; before: there is no rival */
    double rival_error;      /* m/s, at that time */
    double ratio;            /* error / rival_error; NaN without a rival, or if the method lost the scene */
    ErrorsBelow below;
    double time_momentum_20; /* us_solver / that of momentum:k=20; NaN if it was not run */
    double error_scene_net;  /* error / that of scene-net in this scene; likewise */
    double time_scene_net;   /* us_solver / that of scene-net in this scene; likewise */
} EqualTimeRow;

/* Mean errors at the impact, in the time of momentum with 100 sweeps, or with 50 or 20 in a chart without that. */
typedef struct EqualMethodRow {
    const char *scene, *method; /* method: its family */
    double us_solver;           /* the time, microseconds */
    CurveReach reach;  /* where the time lies on the method's curve; before: it takes longer, or lost the scene */
    double error;      /* m/s, at that time; NaN before */
    const char *rival; /* "": none */
    double rival_error, ratio;
    ErrorsBelow below;
    int family; /* index into families */
} EqualMethodRow;

extern const CsvLayout equal_time_layout, equal_methods_layout;

typedef struct EqualTime {
    int count, method_count;
    EqualTimeRow *rows;      /* [count]; texts point into the chart's rows and into curves */
    EqualMethodRow *methods; /* [method_count], scene by scene; none for scenes without such a run of momentum */
    const char *time;        /* the setting of momentum whose time all methods have: "k=100", "k=50" or "k=20" */
    RivalCurves curves;
} EqualTime;

/* The tables of a chart's rows, which must outlive them; the rows of a scene must follow each other. False with error
   set if out of memory. */
bool equal_time_make(EqualTime *table, const ChartRow *rows, int count, Error *error);
void equal_time_free(EqualTime *table);
