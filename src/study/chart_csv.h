/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv: speed and accuracy of every method; one row for each scene, method, setting, protocol and phase. */
#pragma once
#include "common/cpu_name.h"
#include "csv/csv_table.h"
#include "simulate/phases.h"

enum { CHART_MAX_ROWS = 20000, CHART_NAME_SIZE = 128, CHART_SETTING_SIZE = 256 };

/* Frozen: all methods solve the same contact problems. Closed: each method runs on its own trajectory. */
typedef enum ChartProtocol { PROTOCOL_FROZEN, PROTOCOL_CLOSED } ChartProtocol;

enum { PROTOCOLS = PROTOCOL_CLOSED + 1 };

/* NaN if a protocol does not have the value. Errors are RMS velocity errors against the reference; mean, median and p95
   are over all scored steps of all launches. error_worst (closed loop only) is the largest mean error of a launch in
   the phase, over its scored steps (up to where its state became NaN or infinite); launches without scored steps are
   ignored. */
typedef struct ChartRow {
    const char *scene, *method; /* less than CHART_NAME_SIZE bytes */
    const char *setting;        /* "k=20,warm=off"; less than CHART_SETTING_SIZE */
    ChartProtocol protocol;
    Phase phase;
    int launches;
    double us_solver, us_solver_q1, us_solver_q3; /* time in the solver per step: median, quartiles; microseconds */
    double us_step;                               /* of the whole step, median; microseconds */
    double instructions;                          /* in the solver per step */
    double error_mean, error_median, error_p95;   /* m/s */
    double error_worst;                           /* mean of the worst launch, m/s */
    double share_right;                           /* of bodies, 0 to 1 */
    double penetration_max, drift;                /* m */
    double energy;                                /* above the converged run's, J */
    double moved;                                 /* boxes that moved more than 0.5 m */
    const char *cpu; /* processor that times and instructions were measured on; "": not measured, or not known */
} ChartRow;

extern const CsvLayout chart_layout;

typedef struct ChartTable {
    CsvTable csv;
    int count;
    const ChartRow *rows; /* [count] */
} ChartTable;

/* Reads a chart. Refused, as "path:line:column: error: reason": what csv_table_read() refuses (the header is exact; the
   last column, cpu, may be missing), and a median time outside its quartiles. On failure nothing is to be freed. */
bool chart_csv_read(ChartTable *table, const char *path, Error *error);
void chart_csv_free(ChartTable *table);
