/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/rival_curves.h"

#include "simulate/method.h"
#include "study/pareto.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool rival_curves_begin(RivalCurves *curves, int rows, Error *error) {
    const size_t most = (size_t)rows + 1;
    *curves = (RivalCurves){.families = malloc(most * sizeof *curves->families),
                            .rows = malloc(most * sizeof *curves->rows),
                            .family = malloc(most * sizeof *curves->family),
                            .lost = malloc(most * sizeof *curves->lost),
                            .points = malloc(most * sizeof *curves->points)};
    return (curves->families != NULL && curves->rows != NULL && curves->family != NULL && curves->lost != NULL &&
            curves->points != NULL) ||
           error_memory(error, "equal_time");
}

void rival_curves_free(RivalCurves *curves) {
    free(curves->families);
    free(curves->rows);
    free(curves->family);
    free(curves->lost);
    free(curves->points);
    *curves = (RivalCurves){0};
}

static bool counts(const ChartRow *row) {
    const MethodDescription *method = method_describe(row->method);
    return row->protocol == PROTOCOL_CLOSED && row->phase != PHASE_REST && row->us_solver > 0 &&
           !isnan(row->error_mean) && (method == NULL || method->role == METHOD_COMPETES);
}

static int find_family(RivalCurves *curves, const ChartRow *row) {
    char name[CHART_FAMILY_SIZE];
    int i = 0;
    chart_row_family(row, name);
    while (i < curves->family_count && strcmp(curves->families[i].name, name) != 0) i++;
    if (i == curves->family_count) {
        CurveFamily *family = &curves->families[curves->family_count++];
        strcpy(family->name, name);
        strcpy(family->method, row->method);
        family->description = method_describe(row->method);
    }
    return i;
}

void rival_curves_scene(RivalCurves *curves, const ChartRow *rows, int count) {
    curves->count = 0;
    for (int i = 0; i < count; i++) {
        if (!counts(&rows[i])) continue;
        curves->rows[curves->count] = &rows[i];
        curves->family[curves->count] = find_family(curves, &rows[i]);
        curves->lost[curves->count++] = chart_row_lost(rows, count, &rows[i]);
    }
}

double curve_error(const ChartRow *row, CurveStatistic statistic) {
    const double errors[] = {row->error_mean, row->error_median, row->error_p95};
    return errors[statistic];
}

double rival_curves_error(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us,
                          CurveReach *reach) {
    int count = 0;
    for (int i = 0; i < curves->count; i++) {
        const ChartRow *row = curves->rows[i];
        if (curves->family[i] != family || curves->lost[i] || row->phase != phase) continue;
        curves->points[count++] = (CurvePoint){row->us_solver, fmax(curve_error(row, statistic), PARETO_RESOLUTION)};
    }
    *reach = CURVE_BEFORE;
    return count == 0 ? NAN : error_curve_at(curves->points, error_curve_front(curves->points, count), us, reach);
}

static bool is_rival(const CurveFamily *family, const CurveFamily *other) {
    if (strcmp(family->method, other->method) == 0) return false;
    return other->description == NULL || other->description->twin == NULL;
}

BestRival rival_curves_best(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us) {
    BestRival best = {-1, NAN, CURVE_BEFORE};
    for (int i = 0; i < curves->family_count; i++) {
        CurveReach reach;
        if (!is_rival(&curves->families[family], &curves->families[i])) continue;
        const double error = rival_curves_error(curves, i, phase, statistic, us, &reach);
        if (reach != CURVE_BEFORE && !(best.error <= error)) best = (BestRival){i, error, reach};
    }
    return best;
}
