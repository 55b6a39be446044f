/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/pareto.h"

#include "simulate/method.h"

#include <math.h>
#include <string.h>

static bool comparable(const ChartRow *a, const ChartRow *b) {
    return a->phase == b->phase && a->protocol == b->protocol && strcmp(a->scene, b->scene) == 0;
}

static bool competes(const ChartRow *row) {
    const MethodDescription *method = method_describe(row->method);
    if (method != NULL && method->role != METHOD_COMPETES) return false;
    return !isnan(row->us_solver) && !isnan(row->us_solver_q1) && !isnan(row->us_solver_q3) && !isnan(row->error_mean);
}

bool pareto_dominates(const ChartRow *a, const ChartRow *b) {
    return comparable(a, b) && competes(a) && competes(b) && a->us_solver_q3 < b->us_solver_q1 &&
           a->error_mean <= fmax(b->error_mean, PARETO_RESOLUTION);
}

void pareto_mark(const ChartRow *rows, int count, bool *on_front) {
    for (int i = 0; i < count; i++) {
        on_front[i] = competes(&rows[i]);
        for (int k = 0; on_front[i] && k < count; k++) on_front[i] = !pareto_dominates(&rows[k], &rows[i]);
    }
}
