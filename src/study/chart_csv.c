/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/chart_csv.h"

#include <limits.h>
#include <math.h>

static const char *const protocol_words[] = {"frozen", "closed", NULL};
static const char *const phase_words[] = {"impact", "after", "rest", NULL};

#define TEXT(member, size) \
    { #member, CSV_TEXT, .offset = offsetof(ChartRow, member), .maximum = (size)-1, .key = true }
#define WORD(member, list) \
    { #member, CSV_WORD, .offset = offsetof(ChartRow, member), .words = list, .key = true }
#define FIGURE(member, least, most) \
    { #member, CSV_OPTIONAL, .offset = offsetof(ChartRow, member), .minimum = least, .maximum = most }

static const CsvColumn columns[] = {
    TEXT(scene, CHART_NAME_SIZE),
    TEXT(method, CHART_NAME_SIZE),
    TEXT(setting, CHART_SETTING_SIZE),
    WORD(protocol, protocol_words),
    WORD(phase, phase_words),
    {"launches", CSV_INTEGER, .offset = offsetof(ChartRow, launches), .maximum = INT_MAX},
    FIGURE(us_solver, 0, INFINITY),
    FIGURE(us_solver_q1, 0, INFINITY),
    FIGURE(us_solver_q3, 0, INFINITY),
    FIGURE(us_step, 0, INFINITY),
    FIGURE(instructions, 0, INFINITY),
    FIGURE(error_mean, 0, INFINITY),
    FIGURE(error_median, 0, INFINITY),
    FIGURE(error_p95, 0, INFINITY),
    FIGURE(error_worst, 0, INFINITY),
    FIGURE(share_right, 0, 1),
    FIGURE(penetration_max, 0, INFINITY),
    FIGURE(drift, -INFINITY, INFINITY),
    FIGURE(energy, -INFINITY, INFINITY),
    FIGURE(moved, 0, INFINITY),
    {"cpu", CSV_TEXT, .offset = offsetof(ChartRow, cpu), .maximum = CPU_NAME_SIZE - 1, .optional = true},
};

enum { SOLVER_MEDIAN = 6 };

const CsvLayout chart_layout =
    CSV_LAYOUT("chart", columns, ChartRow, .min_rows = 1, .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);

/* Comparisons with NAN are false: a missing time is not checked. */
static bool is_ordered(const ChartRow *row) {
    return !(row->us_solver_q1 > row->us_solver || row->us_solver > row->us_solver_q3 ||
             row->us_solver_q1 > row->us_solver_q3);
}

bool chart_csv_read(ChartTable *table, const char *path, Error *error) {
    *table = (ChartTable){.count = 0};
    if (!csv_table_read(&table->csv, path, &chart_layout, error)) return false;
    table->count = table->csv.count;
    table->rows = table->csv.rows;
    for (int i = 0; i < table->count; i++) {
        if (is_ordered(&table->rows[i])) continue;
        csv_table_error(&table->csv, i, SOLVER_MEDIAN, error, "us_solver: the median is outside the quartiles");
        chart_csv_free(table);
        return false;
    }
    return true;
}

void chart_csv_free(ChartTable *table) {
    csv_table_free(&table->csv);
    *table = (ChartTable){.count = 0};
}
