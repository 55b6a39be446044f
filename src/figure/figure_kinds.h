/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of figures, one per file figure_NAME.c. */
#pragma once
#include "figure/figure.h"

extern const FigureKind figure_strip, figure_annotated, figure_divergence, figure_strobe, figure_network, figure_pair;
