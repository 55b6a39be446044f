/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of a comparison: report.html, a self-contained page; junit.xml for CI; results.json for programs and for
   approve(). Beside it run-NAME.html, a page that plays both runs (pictures/player.h), for each trajectory that
   differs.

     report_begin("out/report", error);
     regression_report_write(&regression, "out/report", (size_t)REPORT_MEGABYTES << 20, NULL, error); */
#pragma once
#include "base/base.h"
#include "base/json.h"
#include "base/machine.h"
#include "pictures/player.h"
#include "regression/regression.h"

#include <stdio.h>

/* Default limit for the pictures in a report: a browser opens this size in a second or two. */
enum { REPORT_MEGABYTES = 64 };

/* Writes the files into the folder of report_begin(). Pictures of failed frames, then of frames within tolerance,
   are shown as long as they fit into max_bytes; the other frames cannot be approved. The pages of runs may take as much
   again.
   ERROR_INPUT if a file has changed since the comparison. The same comparison gives the same bytes,
   except for the times in junit.xml. */
bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error);

/* The results of a comparison of pictures, or of two runs, as a list of test cases for CI systems. */

typedef struct ReportCase {
    const char *kind; /* "frames" or "trajectories" */
    const char *name, *verdict;
    bool failed;
    RegressionText words;
    const char *paths[SIDES]; /* of the files; NULL: no such file */
    double seconds;
    const RegressionFrame *frame; /* NULL for a trajectory */
} ReportCase;

typedef struct ReportResults {
    const void *comparison;
    int count, failed; /* cases */
    const char *notes; /* lines */
    double seconds;    /* of the whole comparison */
    ReportCase (*at)(const void *comparison, int i);
    void (*write_page)(FILE *file, const void *comparison);
    void (*write_json)(FILE *file, const void *comparison);
} ReportResults;

/* Makes and reserves the folder (folder_reserve()), and removes the files of an earlier report: before any work, so
   that a comparison that fails, or is killed, leaves none. */
bool report_begin(const char *folder, Error *error);

/* Writes report.html, junit.xml and results.json into a folder that exists. results.json is last: if it is
   there, the report is complete. */
bool report_write(const ReportResults *results, const char *folder, Error *error);

/* A link to a moment in a page that plays two runs: "run-NAME.html#t=0.55&body=7". */
enum { REPORT_RUN_SIZE = 256 };
typedef struct ReportLink {
    char text[REPORT_RUN_SIZE + PLAYER_LINK_SIZE];
} ReportLink;

/* Writes the page `name` into the folder: all frames of both runs, or of long ones those around `frame`. The link
   leads to that frame and body. *bytes: of the page. There is no page of runs without a common moment, as their steps
   differ, nor of hashes or of traces of other numbers of bodies. What a trace does not state is drawn as 1/60 s and
   as squares. */
bool report_write_run(Trajectory *const runs[SIDES], int frame, int body, const char *folder, const char *name,
                      ReportLink *link, size_t *bytes, Error *error);

/* What results.json has behind its format, into an object that has begun. */
void regression_write_json(JsonWriter *json, const Regression *regression);
