/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv: speed and accuracy of every method, one row a scene, method, setting, protocol and phase. */
#pragma once
#include "common/error.h"
#include "simulate/phases.h"

enum { CHART_MAX_ROWS = 20000, CHART_NAME_SIZE = 128, CHART_SETTING_SIZE = 256 };

/* Frozen: all methods on the same contact problems. Closed: each on the trajectory that it makes. */
typedef enum ChartProtocol { PROTOCOL_FROZEN, PROTOCOL_CLOSED } ChartProtocol;

enum { PROTOCOLS = PROTOCOL_CLOSED + 1 };

/* NAN where a protocol does not have the figure. Errors are RMS velocities of bodies against the reference solve; mean,
   median and p95 are of all steps scored, whatever their launch. error_worst is of launches in closed loop: the largest
   of their own mean errors in the phase, each over the steps scored of its run (until it left the finite numbers, where
   it did; a launch without such a step has no say). Frozen rows have none: their steps are of no run of the method. */
typedef struct ChartRow {
    char scene[CHART_NAME_SIZE], method[CHART_NAME_SIZE];
    char setting[CHART_SETTING_SIZE]; /* "k=20,warm=off" */
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
} ChartRow;

typedef struct ChartTable {
    int count;
    ChartRow *rows; /* [count] */
} ChartTable;

/* Writes the table as a whole file, numbers with six digits. Refused: texts with control characters, and figures that
   are infinite, as neither could be read again. */
bool chart_csv_write(const char *path, const ChartRow *rows, int count, Error *error);

/* Reads what chart_csv_write wrote: exactly its header, 1 to CHART_MAX_ROWS rows, no row twice, every figure within
   what it can be (no negative time, quartiles around their median, ...). On failure error is "path:line:column:
   error: reason" and nothing is to be freed. */
bool chart_csv_read(ChartTable *table, const char *path, Error *error);
void chart_csv_free(ChartTable *table);
