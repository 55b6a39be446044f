/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a comparison's report. Only regression_report.c and those that write a part include this. */
#pragma once
#include "report/regression.h"

#include <stdio.h>

enum { REPORT_KINDS = 4 }; /* expected, actual, difference, FLIP */
extern const char report_kind_letters[REPORT_KINDS + 1];

typedef struct ReportPicture {
    uint8_t *data; /* a PNG file; NULL: there is none */
    size_t size;
} ReportPicture;

typedef struct ReportPictures {
    int count;                             /* of frames of the comparison */
    ReportPicture (*frames)[REPORT_KINDS]; /* [count], by frame */
    int left_out;                          /* frames that were to be shown, but did not fit */
} ReportPictures;

/* Fills pictures, and `shown` of the frames. On failure nothing is to be freed. */
bool report_pictures_gather(ReportPictures *pictures, Regression *regression, size_t max_bytes,
                            const Progress *progress, Error *error);
void report_pictures_free(ReportPictures *pictures);

typedef struct Report {
    const Regression *regression;
    const ReportPictures *pictures;
    const char *folder; /* of the report, as it was given */
} Report;

/* Each for file_write_text(), of a Report. */
void report_put_page(FILE *file, const void *report);
void report_put_junit(FILE *file, const void *report);
void report_put_json(FILE *file, const void *report);

/* FLIP and the largest difference over the frames, as SVG. */
void report_put_plot(FILE *file, const Regression *regression);
