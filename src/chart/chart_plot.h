/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of speed against accuracy, drawn from chart.csv. */
#pragma once
#include "common/error.h"

/* Draws folder/chart-SCENE.png, .svg and .pdf from the table at csv_path (study/chart_csv.h). x: solver time per
   step; y: mean velocity error; both logarithmic. Two panels: impact frames and the 60 frames after, in closed loop.
   One mark per setting, one line per method, and the Pareto front (study/pareto.h) as a staircase behind. 174 x 100
   mm, a paper's page width; colours and symbols are distinguishable in grey and with colour blindness. The folder
   must exist. ERROR_INPUT for an invalid table, a scene without marks, or a scene name that is not a file name.
   Each file appears complete or not at all. */
bool chart_plot(const char *csv_path, const char *scene, const char *folder, Error *error);
