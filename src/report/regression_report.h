/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a comparison: report.html, a self-contained page; junit.xml and results.tap for CI; results.json for
   programs and for approval (approve.h). Beside it run-NAME.html, a page that plays both runs (player/player.h), for each
   trajectory that differs. */
#pragma once
#include "common/json_write.h"
#include "regression/regression.h"

/* Default limit for the pictures in a report: a browser opens this size in a second or two. */
enum { REPORT_MEGABYTES = 64 };

/* Writes the four files into a folder, created if missing. Pictures of failed frames, then of frames within tolerance,
   are shown as long as they fit into max_bytes; the other frames cannot be approved. The pages of runs may take as much
   again. FLIP is measured for all.
   ERROR_INPUT if a file has changed since the comparison. The same comparison gives the same bytes,
   except for the times in junit.xml. */
bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error);

/* What results.json has behind its format, into an object that has begun. */
void regression_write_json(JsonWriter *json, const Regression *regression);
