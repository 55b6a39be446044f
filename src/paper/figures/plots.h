/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of the study as figures. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

/* Draws folder/figures/NAME.png and .svg and writes NAME.txt, a caption of one line, for NAME =
     loss         table1.csv       mean squared error over training, each target
     factors      networks.csv     error over the constant predictor's, each network
     rates        rates.csv        share of right predictions by three definitions, at impacts and at rest
     closed-loop  closed_loop.csv  frames until divergence, and cost, with a network in place of the solver
     laws         laws.csv         error and violations over the weight of the laws in the loss
     transfer     transfer.csv     error over launches, from scratch and after smaller scenes
     system-NAME  system_NAME.csv  what the claims of a cited system are judged by (paper/systems/system.h)
   Plots are as wide as a page or a column (sketch/page_width.h). Colour-blind readers can tell their lines apart, and
   so can readers of a grey print.

   ERROR_INPUT, with path:line:column, if one of the tables is missing or damaged; then nothing is drawn. A plot
   whose table has no rows to show is left out; its files from an earlier run stay. ERROR_INTERRUPTED if progress, which
   may be NULL, requests a stop; plots already drawn stay. */
bool plots_draw(const char *folder, const Progress *progress, Error *error);
