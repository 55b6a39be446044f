/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table and the figure of errors at equal time (study/equal_time.h). */
#pragma once
#include "common/error.h"

#include <stdbool.h>

/* Reads a chart.csv and writes folder/equal_time.csv and equal_time_methods.csv, and the latter as a figure,
   folder/equal_time.png, .svg and .pdf: a row for each scene, a column for each method, in each cell its error as a ratio to
   that of its best rival in the same time. *drawn: false if no method has a rival. */
bool equal_time_plot(const char *chart_csv, const char *folder, bool *drawn, Error *error);
