/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fills a Markdown template with values from CSV files. The template has no logic; it has these tags:

     {{NAME}}                    the value NAME
     {{NAME FORMAT}}             the same as a number: number (3 significant digits), percent (0.25: 25.0%), score (6
                                 decimals)
     {{each FILE FILTER ...}}    on a line of its own: the lines up to its {{end}} once for every row of the CSV file that
     {{end}}                     passes the filters. Such regions may be nested.
     {{caption FILE}}            a text file of one line

   NAME is a column of the row of the innermost region that has it; outside of all regions, a row of the values file (key,
   value). A FILTER is COLUMN=VALUE, or COLUMN: equal to the value COLUMN outside of the region. Empty fields and
   numbers that are NaN are shown as a dash. Values are escaped: they have no meaning to Markdown. */
#pragma once
#include "common/error.h"

#include <stdio.h>

/* Paths in the template and that of the values file are relative to the folder. ERROR_INPUT for files that are missing or
   damaged, with path:line:column for CSV files, and for values that the template has and the files have not. */
bool template_fill(const char *template, const char *folder, const char *values, FILE *out, Error *error);
