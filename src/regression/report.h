/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a comparison writes, and what approve accepts. */
#pragma once
#include "base/base.h"
#include "base/json.h"
#include "base/machine.h"
#include "pictures/player.h"
#include "regression/regression.h"

#include <stdio.h>

/* Accepts the changes that a comparison's report shows. Nothing else changes expected files. */

typedef struct Approval {
    int replaced, added, removed; /* files of the expected folder */
    int already;                  /* approved earlier */
    int kept;                     /* expected files without an actual one: MISSING_KEPT */
    int not_shown;                /* failures whose pictures the report omitted; not approved */
    int not_selected;             /* failures whose names do not match */
} Approval;

/* What becomes of expected files that have no actual one: a test may be gone, or the run may have drawn only some. */
typedef enum ApprovalMissing { MISSING_REFUSED, MISSING_KEPT, MISSING_REMOVED } ApprovalMissing;

typedef struct ApprovalRequest {
    const char *report;   /* folder of results.json */
    const char *expected; /* the folder to change; NULL: the one that results.json names, below the current directory */
    const char *only;     /* a glob (fnmatch) of file names; NULL: all */
    ApprovalMissing missing;
    void (*on_change)(const char *what, const char *path); /* after each file: "replaced", "added" or "removed" */
} ApprovalRequest;

/* Replaces the expected files of failures by the actual ones, in the folder that results.json names, and removes
   expected files whose actual file is missing, if the request says so: ERROR_INPUT, and nothing is changed, if it says
   nothing.

   Everything is checked before anything is written: names must be plain names of .png and .npz files, and both files
   must be regular files with the hashes in the report; otherwise ERROR_INPUT. Files are written atomically, in folders
   that stay open; no link below the expected folder is followed. */
bool approve(const ApprovalRequest *request, Approval *approval, Error *error);

/* The report of a comparison: report.html, a self-contained page; junit.xml and results.tap for CI; results.json for
   programs and for approval. Beside it run-NAME.html, a page that plays both runs (pictures/player.h), for each
   trajectory that differs. */

/* Default limit for the pictures in a report: a browser opens this size in a second or two. */
enum { REPORT_MEGABYTES = 64 };

/* Writes the four files into a folder, created if missing. Pictures of failed frames, then of frames within tolerance,
   are shown as long as they fit into max_bytes; the other frames cannot be approved. The pages of runs may take as much
   again. FLIP is measured for all.
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

/* Writes report.html, junit.xml, results.tap and results.json into a folder that exists. results.json is last: if it is
   there, the report is complete. */
bool report_write(const ReportResults *results, const char *folder, Error *error);

/* A link to a moment in a page that plays two runs: "run-NAME.html#t=0.55&body=7". */
enum { REPORT_RUN_SIZE = 256 };
typedef struct ReportLink {
    char text[REPORT_RUN_SIZE + PLAYER_LINK_SIZE];
} ReportLink;

/* Writes the page `name` into the folder: all frames of both runs, or of long ones those around `frame`. The link leads
   to that frame and body. *bytes: of the page. */
bool report_write_run(const Trajectory *const runs[SIDES], int frame, int body, const char *folder, const char *name,
                      ReportLink *link, size_t *bytes, Error *error);

/* What results.json has behind its format, into an object that has begun. */
void regression_write_json(JsonWriter *json, const Regression *regression);

/* The results of a comparison for GitHub Actions: annotations (workflow commands on standard output) and the step
   summary (Markdown). Source: docs.github.com, "Workflow commands for GitHub Actions". Names and messages are escaped:
   none can become a command or markup. Other output with names belongs between "::stop-commands::TOKEN" and
   "::TOKEN::", with a token that nobody can know before: a runner searches whole lines for old commands ("##[...]"). */

/* GitHub shows ten errors of a step and drops the others. */
enum { GITHUB_ANNOTATIONS_MAX = 10 };

/* GitHub refuses a larger summary of a step as a whole. */
enum { GITHUB_SUMMARY_MAX = 1 << 20 };

/* An error for each failure, and one for successive frames of a sequence that failed alike; at most
   GITHUB_ANNOTATIONS_MAX: if there are more, the last one counts the others. */
void github_annotate(FILE *out, const Regression *regression);

/* One error that is about no file. */
void github_annotate_message(FILE *out, const char *message);

/* Appends the summary to a file, which stays below GITHUB_SUMMARY_MAX bytes: rows that do not fit are counted. Writes
   nothing if not even the head fits. */
bool github_summary_append(const Regression *regression, const char *path, Error *error);
