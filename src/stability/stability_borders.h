/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far each method holds, in each study. */
#pragma once
#include "chart/gnuplot_page.h"
#include "stability/stability_table.h"

enum { BORDERS_MAX_METHODS = 24, BORDERS_MAX_STUDIES = 32 };

/* Writes the figure and its caption: a panel a study, on the study's own axis, and in it a row a method. A bar goes over
   what holds, up to holds_at; a tile at fails_at, or at the far end where luck decides beyond the bar, tells how it fails
   (stability/verdict_look.h). What holds over the whole range has an arrow at its end, what never holds a cross at its
   beginning. Refused, with path:line:column: more than BORDERS_MAX_METHODS methods or BORDERS_MAX_STUDIES studies. */
bool stability_borders_write(const BorderTable *table, GnuplotPage *page, Error *error);
