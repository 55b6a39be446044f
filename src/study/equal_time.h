/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every method's error next to the error that its best rival (rival_curves.h) has in the same time: equal_time.csv for
   each setting at the time that it takes, equal_time_methods.csv for each method at one time for all in a scene. */
#pragma once
#include "csv/csv_table.h"
#include "study/rival_curves.h"

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
    double time_momentum_20; /* us_solver / that of momentum:k=20; NaN if it was not run */
    double error_scene_net;  /* error / that of scene-net in this scene; likewise */
    double time_scene_net;   /* us_solver / that of scene-net in this scene; likewise */
} EqualTimeRow;

/* Mean errors at the impact, in the time of momentum with 50 sweeps, or with 20 in a chart without that. */
typedef struct EqualMethodRow {
    const char *scene, *method; /* method: its family */
    double us_solver;           /* the time, microseconds */
    CurveReach reach;  /* where the time lies on the method's curve; before: it takes longer, or lost the scene */
    double error;      /* m/s, at that time; NaN before */
    const char *rival; /* "": none */
    double rival_error, ratio;
    int family; /* index into families */
} EqualMethodRow;

extern const CsvLayout equal_time_layout, equal_methods_layout;

typedef struct EqualTime {
    int count, method_count;
    EqualTimeRow *rows;      /* [count]; texts point into the chart's rows and into curves */
    EqualMethodRow *methods; /* [method_count], scene by scene; none for scenes without such a run of momentum */
    const char *time;        /* the setting of momentum whose time all methods have: "k=50", else "k=20" */
    RivalCurves curves;
} EqualTime;

/* The tables of a chart's rows, which must outlive them; the rows of a scene must follow each other. False with error set
   if out of memory. */
bool equal_time_make(EqualTime *table, const ChartRow *rows, int count, Error *error);
void equal_time_free(EqualTime *table);
