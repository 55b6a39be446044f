/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/chart_internal.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
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

static void sweep(const FloatRange *bomb_x, const Scene *scene, Launch *out) {
    for (int i = 0; i < bomb_x->count; i++) {
        out[i] = launch_of(scene);
        out[i].x = range_value(bomb_x, i);
    }
}

Launch *launch_choice_make(const LaunchChoice *choice, const Scene *scene, int standard, int *count, Error *error) {
    LaunchTable table = {0};
    if (choice->table != NULL && !launches_read(&table, choice->table, error)) return NULL;
    *count = choice->table != NULL      ? table.count
             : choice->bomb_x.count > 0 ? choice->bomb_x.count
             : choice->count > 0        ? choice->count
                                        : standard;
    Launch *launches = malloc((size_t)*count * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "launches");
    if (ok && choice->table != NULL)
        ok = launches_for(&table, scene, launches, error);
    else if (ok && choice->bomb_x.count > 0)
        sweep(&choice->bomb_x, scene, launches);
    else if (ok)
        ok = launches_for_scoring(scene, *count, launches, error);
    launches_free(&table);
    ok = ok && launches_check(scene, launches, *count, error);
    if (ok) return launches;
    free(launches);
    return NULL;
}

static const double lost_drift = 0.5; /* m, half a box */

void chart_split_setting(const char *setting, char *numbers, char *words) {
    while (*setting != '\0') {
        size_t length = strcspn(setting, ",");
        char item[CHART_SETTING_SIZE];
        snprintf(item, sizeof item, "%.*s", (int)length, setting);
        const char *value = strchr(item, '=');
        double number;
        bool is_number = value != NULL && parse_double(value + 1, &number);
        char *part = is_number ? numbers : words;
        if (part[0] != '\0') strcat(part, ",");
        strcat(part, item);
        setting += length + (setting[length] == ',');
    }
}

void chart_row_family(const ChartRow *row, char family[CHART_FAMILY_SIZE]) {
    char numbers[2 * CHART_SETTING_SIZE] = "", words[2 * CHART_SETTING_SIZE] = "";
    chart_split_setting(row->setting, numbers, words);
    snprintf(family, CHART_FAMILY_SIZE, "%s%s%s", row->method, words[0] != '\0' ? ":" : "", words);
}

bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row) {
    for (int i = 0; i < count; i++) {
        const ChartRow *rest = &rows[i];
        if (rest->drift > lost_drift && strcmp(rest->scene, row->scene) == 0 &&
            strcmp(rest->method, row->method) == 0 && strcmp(rest->setting, row->setting) == 0)
            return true;
    }
    return false;
}

/* A row has both a time and an error, or its phase did not occur. */
static bool is_left_out(const ChartRow *row) { return isnan(row->us_solver) && !isnan(row->error_mean); }

void chart_times_note(char note[CHART_TIMES_SIZE], const ChartRow *rows, int count) {
    const char *cpu = NULL;
    bool left_out = false, others = false;
    for (int i = 0; i < count; i++) {
        left_out |= is_left_out(&rows[i]);
        if (rows[i].cpu[0] == '\0') continue;
        if (cpu == NULL) cpu = rows[i].cpu;
        others |= strcmp(rows[i].cpu, cpu) != 0;
    }
    note[0] = '\0';
    if (cpu != NULL)
        snprintf(note, CHART_TIMES_SIZE, "Times measured on %s%s.%s", cpu, others ? " and others" : "",
                 left_out ? " Those of other processors are left out." : "");
}

bool chart_scene_untimed(const ChartRow *rows, int count, const char *scene) {
    bool known = false;
    for (int i = 0; i < count; i++) {
        if (strcmp(rows[i].scene, scene) == 0 && !isnan(rows[i].us_solver)) return false;
        known |= rows[i].cpu[0] != '\0';
    }
    return known;
}
