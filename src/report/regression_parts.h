/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a comparison's report. Only regression_report.c and the writers of parts include this. */
#pragma once
#include "player/player.h"
#include "regression/regression.h"

#include <stdio.h>

enum { REPORT_KINDS = 4 }; /* expected, actual, difference, FLIP */
extern const char report_kind_letters[REPORT_KINDS + 1];

typedef struct ReportPicture {
    uint8_t *data; /* a PNG file, or NULL */
    size_t size;
} ReportPicture;

typedef struct ReportPictures {
    int count;                             /* frames of the comparison */
    ReportPicture (*frames)[REPORT_KINDS]; /* [count], by frame */
    int left_out;                          /* frames whose pictures did not fit */
} ReportPictures;

/* Fills the pictures, and `shown` and `flip` of the frames. On failure nothing needs to be freed. */
bool report_pictures_gather(ReportPictures *pictures, Regression *regression, size_t max_bytes,
                            const Progress *progress, Error *error);
void report_pictures_free(ReportPictures *pictures);

/* The pages of runs that differ. */
enum { REPORT_RUN_SIZE = 256 };
typedef struct ReportRuns {
    char (*links)[REPORT_RUN_SIZE +
                  PLAYER_LINK_SIZE]; /* [runs of the comparison] "run-NAME.html#t=0.55&body=7", or empty */
    int left_out;                    /* runs whose page did not fit */
} ReportRuns;

/* Writes the pages into the folder, as long as they fit into max_bytes: both runs, opened at the first difference.
   ERROR_INPUT if a run has changed since the comparison. On failure nothing needs to be freed. */
bool report_runs_write(ReportRuns *runs, const Regression *regression, const char *folder, size_t max_bytes,
                       const Progress *progress, Error *error);
void report_runs_free(ReportRuns *runs);

typedef struct Report {
    const Regression *regression;
    const ReportPictures *pictures;
    const ReportRuns *runs;
    const char *folder; /* of the report, as given */
} Report;

/* Writers for file_write_text(); `report` is a Report. */
void report_write_page(FILE *file, const void *report);
void report_write_junit(FILE *file, const void *report);
void report_write_tap(FILE *file, const void *report);
void report_write_json(FILE *file, const void *report);

/* Plots FLIP and the largest difference over the frames, as HTML with SVG. There must be a frame. */
void report_write_plot(FILE *file, const Regression *regression);
