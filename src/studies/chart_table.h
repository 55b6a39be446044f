/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv: speed and accuracy of every method, one row for each scene, method, setting, protocol and phase; and
   what charts and tables read in these rows. */
#pragma once
#include "base/csv.h"
#include "base/machine.h"
#include "scenes/scenes.h"

#include <stdbool.h>

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
    double us_solver, us_step;                  /* microseconds a step: in the solver, in all (studies/timing.h) */
    double error_mean, error_median, error_p95; /* m/s */
    double error_worst;                         /* mean of the worst launch, m/s */
    double share_right;                         /* of bodies, 0 to 1 */
    double penetration_max, drift;              /* m */
    double energy;                              /* above the converged run's, J */
    double moved;                               /* boxes that moved more than 0.5 m */
    const char *cpu; /* processor that times were measured on; "": not measured, or not known */
    /* of an external method, which has no other times: what its engine says that a step took */
    double us_engine;
    /* J, N s, J: largest violation of a step (methods/criteria.h), mean over the scored steps with impulses. NaN: none
       has. */
    double signorini, cone, dissipation;
    double rollout_mse; /* m^2: as in RunMeasures, mean over the launches */
    /* m/s: that of a step (reference_floor()), mean; of the frozen steps, in closed loop of the converged runs' steps
       that would be scored and that launches do not share. NaN: none, or not measured. The same for all methods. */
    double floor;
    int worst_launch; /* of error_worst, of the study's; not in the table */
} ChartRow;

/* The header is exact, but that the last columns, from cpu on, may be missing. */
extern const CsvLayout chart_layout;

static inline const ChartRow *chart_row(const CsvTable *table, int i) { return (const ChartRow *)table->rows + i; }

/* What charts and tables of chart.csv read from its rows. */

enum { CHART_FAMILY_SIZE = CHART_NAME_SIZE + 2 * CHART_SETTING_SIZE };

enum { CHART_TIMES_SIZE = CPU_NAME_SIZE + 200 };

/* Splits "k=20,warm=off" into numbers "k=20" and words "warm=off", appended to texts of 2 * CHART_SETTING_SIZE. */
void chart_split_setting(const char *setting, char *numbers, char *words);

/* The family of a row: its method with the words of its setting ("engine:warm=off"). Settings of one family differ in
   numbers only. */
void chart_row_family(const ChartRow *row, char family[CHART_FAMILY_SIZE]);

/* m/s: smaller errors count as equal: PARETO_RESOLUTION, or the floor if that is larger. */
double chart_row_resolution(const ChartRow *row);

/* True if the boxes drifted by half a metre before the bomb came: the method was scored on another scene. */
bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row);

/* "Times measured on PROCESSOR."; "" if no row names one. */
void chart_times_note(char note[CHART_TIMES_SIZE], const ChartRow *rows, int count);
