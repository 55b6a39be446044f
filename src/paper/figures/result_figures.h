/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a study measured, as figures of a paper. */
#pragma once
#include "common/error.h"

/* Draws folder/figures/NAME.png and .svg (chart/gnuplot.h) and NAME.txt, a caption of one line of plain text, for
   NAME =
     loss         table1.csv       mean squared error over training, each target
     factors      networks.csv     error over the constant predictor's, each network
     rates        rates.csv        share of right predictions: three readings, at impacts and at rest
     closed-loop  closed_loop.csv  frames until apart, and cost, with a network in place of the solver
     laws         laws.csv         error and violations over the weight of the laws in the loss
     transfer     transfer.csv     error over launches, from scratch and after smaller scenes
   Columns are found by name, in any order; others are left alone. Pages and columns of a paper wide
   (sketch/page_width.h); told apart by the colour-blind and in grey.

   Each of the six tables has to be there and in order: else "path:line:column: error: text", and nothing is drawn. A
   table may lack the rows that its figure shows: then that figure is left out (one of an earlier run stays).
   ERROR_SYSTEM where gnuplot is missing or fails; figures already drawn stay. */
bool result_figures_draw(const char *folder, Error *error);
