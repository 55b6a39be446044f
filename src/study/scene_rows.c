/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_rows.h"

#include "study/statistics.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

void scene_row_errors(ChartRow *row, const PhaseScores *scores) {
    row->error_mean = statistics_mean(scores->error, scores->count);
    row->share_right = statistics_mean(scores->share, scores->count);
    row->error_median = statistics_quantile(scores->error, scores->count, 0.5);
    row->error_p95 = statistics_quantile(scores->error, scores->count, 0.95);
}

/* Mean or largest over the launches for which the measure at byte `offset` is not NaN. */
static double over_launches(const RunMeasures *measures, int count, size_t offset, bool largest) {
    double sum = 0, most = NAN;
    int found = 0;
    for (int i = 0; i < count; i++) {
        double value;
        memcpy(&value, (const char *)&measures[i] + offset, sizeof value);
        if (isnan(value)) continue;
        sum += value;
        found++;
        if (!(most >= value)) most = value;
    }
    return largest ? most : found > 0 ? sum / found : NAN;
}

void scene_row_measures(ChartRow *row, const RunMeasures *measures, int count) {
    size_t phase = (size_t)row->phase;
    row->penetration_max =
        over_launches(measures, count, offsetof(RunMeasures, penetration) + phase * sizeof(double), true);
    row->energy = over_launches(measures, count, offsetof(RunMeasures, energy) + phase * sizeof(double), false);
    if (row->phase != PHASE_REST) return;
    row->drift = over_launches(measures, count, offsetof(RunMeasures, drift), false);
    row->moved = over_launches(measures, count, offsetof(RunMeasures, moved), false);
}

ChartRow scene_row(const char *scene, int launches, const Contender *contender, int protocol, int phase) {
    return (ChartRow){.scene = scene,
                      .method = contender->name,
                      .setting = contender->setting,
                      .protocol = (ChartProtocol)protocol,
                      .phase = (Phase)phase,
                      .launches = launches,
                      .us_solver = NAN,
                      .us_solver_q1 = NAN,
                      .us_solver_q3 = NAN,
                      .us_step = NAN,
                      .instructions = NAN,
                      .error_worst = NAN,
                      .penetration_max = NAN,
                      .drift = NAN,
                      .energy = NAN,
                      .moved = NAN,
                      .cpu = ""};
}

void scene_row_cost(ChartRow *row, const StepCost *cost, const char *cpu) {
    row->us_solver = cost->solver;
    row->us_solver_q1 = cost->solver_q1;
    row->us_solver_q3 = cost->solver_q3;
    row->us_step = cost->step;
    row->instructions = cost->instructions;
    if (!isnan(cost->solver)) row->cpu = cpu;
}
