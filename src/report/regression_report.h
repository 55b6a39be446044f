/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a comparison: report.html, one page that needs nothing else, for eyes; junit.xml for CI; results.json for
   programs, and for approval (approve.h). */
#pragma once
#include "report/regression.h"

/* What the pictures in a report may take by default: a browser opens that in a second or two. */
enum { REPORT_MEGABYTES = 64 };

/* Writes the three into a folder, made where it is missing. Of frames that failed, and then of those within tolerance, the
   first whose pictures fit into max_bytes are shown; the others say that they are not, and cannot be approved. FLIP is measured
   of all. ERROR_INPUT
   where a file is no longer what was compared. The same comparison gives the same bytes. */
bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error);
