/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fills a Markdown template with values from CSV files. Its tags:

     {{NAME}}            the value NAME, as text, cut to the length of a name
     {{NAME text}}       the same, not cut: a text of one line of UTF-8
     {{NAME FORMAT}}     as a number: number (three significant digits), percent (0.25 is 25.0%), score (six decimals);
                         NAME may be a ratio: test/constant, frames/60
     {{caption FILE}}    the text of a file of one line
     {{each FILE FILTER ...}} TEXT {{end}}
                         the text, once for every row of the CSV file that passes all filters. A filter is COLUMN=WORD,
                         COLUMN=WORD|WORD, or COLUMN, which must equal the value COLUMN outside of the text. A line end
                         directly after {{each ...}} or {{end}} is left out.

   NAME is a column of the innermost row that has it; outside of all rows, a key of the values file (key, value). Empty
   fields and NaN or infinite numbers are shown as a dash. No character of a value has a meaning to Markdown. */
#pragma once
#include "common/error.h"

#include <stdio.h>

/* Paths in the template and that of the values file are relative to the folder. ERROR_INPUT for files that are missing
   or damaged, with path:line:column for CSV files; for tags that are wrong; for names without a value. */
bool template_fill(const char *template, const char *folder, const char *values, FILE *out, Error *error);
