/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of chart.csv from the results of a scene's launches. */
#pragma once
#include "study/contenders.h"
#include "study/method_scores.h"
#include "study/timing.h"

/* A row with names but without results. The names must outlive the row. */
ChartRow scene_row(const char *scene, int launches, const Contender *contender, int protocol, int phase);

/* Sets mean, quantiles and share over all steps of the row's phase; sorts the scores. */
void scene_row_errors(ChartRow *row, const PhaseScores *scores);

/* Largest penetration and means of the other measures over measures[count], one per launch. */
void scene_row_measures(ChartRow *row, const RunMeasures *measures, int count);

/* cpu: that it was measured on; must outlive the row. */
void scene_row_cost(ChartRow *row, const StepCost *cost, const char *cpu);
