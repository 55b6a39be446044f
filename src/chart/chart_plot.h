/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of speed against accuracy, from the table on disk. */
#pragma once
#include "common/error.h"

/* Draws folder/chart-SCENE.png, .svg and .pdf from the table at csv_path (study/chart_csv.h): time in the solver per
   step across, mean velocity error up, both logarithmic; impact frames and the 60 after, in closed loop. One mark a
   setting, one line a method; what nobody beats (study/pareto.h) is a staircase behind. A page of a paper wide (174 x
   85 mm); colours and symbols can be told apart by the colour-blind and in grey. The folder must be there. Refused: a
   table that is not in order, a scene without marks, a scene whose name is no file name. ERROR_SYSTEM where gnuplot
   is missing or fails; no file is put in place before all are drawn. */
bool chart_plot(const char *csv_path, const char *scene, const char *folder, Error *error);
