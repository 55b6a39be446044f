/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv, and what charts read in its rows. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "studies/chart_table.h"
#include "studies/statistics.h"

#include <limits.h>
#include <math.h>
#include <string.h>

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

double chart_row_resolution(const ChartRow *row) { return fmax(PARETO_RESOLUTION, row->floor); }

bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row) {
    for (int i = 0; i < count; i++) {
        const ChartRow *rest = &rows[i];
        if (rest->drift > lost_drift && strcmp(rest->scene, row->scene) == 0 &&
            strcmp(rest->method, row->method) == 0 && strcmp(rest->setting, row->setting) == 0)
            return true;
    }
    return false;
}

void chart_times_note(char note[CHART_TIMES_SIZE], const ChartRow *rows, int count) {
    const char *cpu = NULL;
    bool others = false;
    for (int i = 0; i < count; i++) {
        if (rows[i].cpu[0] == '\0') continue;
        if (cpu == NULL) cpu = rows[i].cpu;
        others |= strcmp(rows[i].cpu, cpu) != 0;
    }
    note[0] = '\0';
    if (cpu != NULL) snprintf(note, CHART_TIMES_SIZE, "Times measured on %s%s.", cpu, others ? " and others" : "");
}

static const char *const protocol_words[] = {"frozen", "closed", NULL};
static const char *const phase_words[] = {"impact", "after", "rest", NULL};

#define TEXT(member, size) CSV_MEMBER(ChartRow, member, CSV_TEXT, .maximum = (size)-1, .key = true)
#define WORD(member, list) CSV_MEMBER(ChartRow, member, CSV_WORD, .words = list, .key = true)
#define FIGURE(member, least, most) CSV_MEMBER(ChartRow, member, CSV_OPTIONAL, .minimum = least, .maximum = most)

static const CsvColumn columns[] = {
    TEXT(scene, CHART_NAME_SIZE),
    TEXT(method, CHART_NAME_SIZE),
    TEXT(setting, CHART_SETTING_SIZE),
    WORD(protocol, protocol_words),
    WORD(phase, phase_words),
    CSV_MEMBER(ChartRow, launches, CSV_INTEGER, .maximum = INT_MAX),
    FIGURE(us_solver, 0, INFINITY),
    FIGURE(us_step, 0, INFINITY),
    FIGURE(error_mean, 0, INFINITY),
    FIGURE(error_median, 0, INFINITY),
    FIGURE(error_p95, 0, INFINITY),
    FIGURE(error_worst, 0, INFINITY),
    FIGURE(share_right, 0, 1),
    FIGURE(penetration_max, 0, INFINITY),
    FIGURE(drift, -INFINITY, INFINITY),
    FIGURE(energy, -INFINITY, INFINITY),
    FIGURE(moved, 0, INFINITY),
    CSV_MEMBER(ChartRow, cpu, CSV_TEXT, .maximum = CPU_NAME_SIZE - 1, .optional = true),
    CSV_MEMBER(ChartRow, us_engine, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
    CSV_MEMBER(ChartRow, signorini, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
    CSV_MEMBER(ChartRow, cone, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
    CSV_MEMBER(ChartRow, dissipation, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
    CSV_MEMBER(ChartRow, rollout_mse, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
    CSV_MEMBER(ChartRow, floor, CSV_OPTIONAL, .maximum = INFINITY, .optional = true),
};

const CsvLayout chart_layout =
    CSV_LAYOUT("chart", columns, ChartRow, .min_rows = 1, .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);
