/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What shows the study of the paper (Avatavului, Ifrim, Voncila 2023): its figures and its report. */
#pragma once
#include "base/base.h"
#include "base/machine.h"

/* Writes folder/report.md: the tables of the study in the folder and its figures, which are drawn, with a sentence for
   each. The same folder gives the same bytes. ERROR_INPUT where a table or a caption is missing or damaged; then there
   is no report. */
bool paper_report_write(const char *folder, Error *error);

/* The figures of the paper (Avatavului, Ifrim, Voncila 2023, figures 1 to 4), drawn from runs of this engine. */

/* Names of the figures in the paper's order, ended by NULL: loop (the stages of a step), narrow-phase (the contact of
   two boxes), data (how training data are made), scenes. */
extern const char *const illustration_names[];

/* Runs single.yaml, stack.yaml and pyramid.yaml of scenes_folder with the engine, and draws folder/NAME.png and .svg,
   as wide as a page (figures/sketch.h). folder/NAME.txt is the caption with the numbers of the run: one line of
   text. The folder must exist. ERROR_INPUT where a scene cannot be read, has no bomb, or never shows what the figure is
   about. The renderer runs in this process and sets Mesa's environment variables (pictures/render.h). */
bool illustrations_draw(const char *scenes_folder, const char *folder, Error *error);

/* The results of the study as figures. */

/* Draws folder/figures/NAME.png and .svg and writes NAME.txt, a caption of one line, for NAME =
     loss         table1.csv       mean squared error over training, each target
     factors      networks.csv     error over the constant predictor's, each network
     rates        rates.csv        share of right predictions by three definitions, at impacts and at rest
     closed-loop  closed_loop.csv  frames until divergence, and cost, with a network in place of the solver
     laws         laws.csv         error and violations over the weight of the laws in the loss
     transfer     transfer.csv     error over launches, from scratch and after smaller scenes
   Plots are as wide as a page or a column (figures/sketch.h). Colour-blind readers can tell their lines apart, and
   so can readers of a grey print.

   ERROR_INPUT, with path:line:column, if one of the tables is missing or damaged; then nothing is drawn. A plot
   whose table has no rows to show is left out; its files from an earlier run stay. ERROR_INTERRUPTED if progress, which
   may be NULL, requests a stop; plots already drawn stay. */
bool plots_draw(const char *folder, const Progress *progress, Error *error);
