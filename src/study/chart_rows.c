/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/chart_rows.h"

#include "common/parse.h"

#include <math.h>
#include <stdio.h>
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
