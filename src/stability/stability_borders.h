/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The borders figure: how far each method holds in each study. */
#pragma once
#include "sketch/plot_page.h"
#include "stability/stability_table.h"

enum { BORDERS_MAX_METHODS = 24, BORDERS_MAX_STUDIES = 32 };

/* Writes the figure and its caption: one panel per study, with its own axis, and one row per method. A bar covers the
   values that hold, up to holds_at. A tile at fails_at shows how the method fails (stability/verdict_look.h); if the
   values beyond the bar are undecided, it is at the far end. An arrow marks a method that holds over the whole range, a
   cross one that never holds. ERROR_INPUT, with path:line:column: more than BORDERS_MAX_METHODS methods or
   BORDERS_MAX_STUDIES studies. */
bool stability_borders_write(const BorderTable *table, PlotPage *page, Error *error);
