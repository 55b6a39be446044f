/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of figures of runs, each in a file of its own (src/figure/figure_NAME.c). */
#pragma once
#include "figure/run_figures.h"

extern const FigureKind figure_strip, figure_annotated, figure_divergence, figure_strobe, figure_network, figure_pair;
