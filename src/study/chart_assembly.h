/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv from the pieces of the study. */
#pragma once
#include "study/chart_plan.h"

enum { ROWS_EACH = PROTOCOLS * PHASES };

/* What the pieces of a scene say about its reference solves. */
typedef struct SceneSolves {
    double frozen_residual;      /* m/s: largest residual of those of frozen steps */
    int64_t solves, unconverged; /* those in closed loop; those with a residual above SOLVE_CONVERGED (rollout.h) */
} SceneSolves;

/* Fills rows[contenders of the scene * ROWS_EACH]. Their texts are the scene's, but for cpu[CPU_NAME_SIZE]. Memory: of some
   methods on all launches, and of one piece. ERROR_INPUT for a piece whose results are damaged. */
bool chart_assemble(const Pieces *pieces, const ChartScene *scene, ChartRow *rows, char cpu[CPU_NAME_SIZE],
                    SceneSolves *solves, Error *error);
