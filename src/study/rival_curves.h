/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of a chart, each with its curve of error over time in one scene.

   A family is a method with the words of its setting ("engine:warm=off"); its settings differ in numbers. The rivals of a
   method are the families of other methods that learn nothing; a learned method's silenced twin is no rival of it. The
   best rival at a time is the one with the least error in that time. Closed loop only. Baselines, the reference and rows
   without time or error are left out; a setting that lost the scene is on no curve. Errors below PARETO_RESOLUTION count
   as that. */
#pragma once
#include "common/error.h"
#include "common/method_description.h"
#include "study/chart_rows.h"
#include "study/error_curve.h"

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

/* For charts of at most `rows` rows. False with error set if out of memory; free it in any case. */
bool rival_curves_begin(RivalCurves *curves, int rows, Error *error);
void rival_curves_free(RivalCurves *curves);

/* Takes the rows of one scene; they must outlive their use. */
void rival_curves_scene(RivalCurves *curves, const ChartRow *rows, int count);

double curve_error(const ChartRow *row, CurveStatistic statistic);

/* The error of a family at a time, as error_curve_at(); NAN and CURVE_BEFORE too for a family without a curve. */
double rival_curves_error(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us,
                          CurveReach *reach);

typedef struct BestRival {
    int family;       /* -1: no rival has a setting as quick */
    double error;     /* m/s; NAN without a rival */
    CurveReach reach; /* CURVE_BEFORE without a rival */
} BestRival;

BestRival rival_curves_best(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us);
