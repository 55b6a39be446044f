/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of regression_run(), and of its report. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <stdio.h>

/* Runs: runs.c */

/* Finds and compares the .npz files of the same name in both folders. Ignores those that are a trajectory in neither
   folder; cannot compare those that are one in only one of them. */
bool regression_find_runs(Regression *regression, Error *error);
void regression_free_run(RegressionRun *run);

/* States and names: states.c */

/* Sets the states verdict of a frame, and whether it fails: with limits of poses, if one of its runs that differ
   exceeds them; otherwise unless a limit of pixels is given, which then alone decides. data: the two PNG files, whose
   texts are read. False with error set when memory is short. */
bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Tolerance *limits, Error *error);

/* *named: whether the changes of a frame, whose size is known, can have names: both folders say what their pictures
   show. Thread-safe. */
bool regression_may_name(Regression *regression, const RegressionFrame *frame, bool *named, Error *error);

/* Sets `changes` to these regions, without names. */
bool regression_keep_regions(RegressionFrame *frame, const ImageRegions *regions, Error *error);

/* Names of what changed in a frame that fails and has regions: sets `changes` and `other_view`. data: the two PNG
   files, whose texts are read. levels: of naming_find(). Thread-safe. False with error set if out of memory. */
bool regression_name_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             uint8_t *levels, Error *error);

/* Causes: causes.c. Groups failed frames by cause: fills `causes`. A frame may have several. False with error set if
   out of memory. */
bool regression_find_causes(Regression *regression, Error *error);

/* Pixels: regression.c. Cuts both pictures of a frame to their overlap, and marks in *masked[height, width] what is
   ignored (antialias.h): masks, and edges if the tolerance says so. *masked is malloc'ed, or NULL if nothing can be
   ignored. */
bool regression_ignore(const Regression *regression, const RegressionFrame *frame, Image *expected, Image *actual,
                       uint8_t **masked, Error *error);

/* The expected picture, pale and grey, with differing pixels coloured: yellow for 1, over red, to violet for 255. What
   `masked` ignores is hatched if it is masked, and blue if it differs as limits allow. Both pictures must have the same
   size. The difference picture has [height, width] and at least this size; what lies beyond both pictures is striped. A
   PNG file, malloc'ed; NULL with error set if out of memory. */
uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error);

/* The fixed parts of report.html (src/regression/page), embedded in the binary by base/tools/embed.cmake. */

extern const char report_page_css[], report_page_html[], report_help_html[];
extern const char report_script[];
extern const unsigned char report_script_sha256[];

/* The parts of a comparison's report. */

enum { REPORT_KINDS = 3 }; /* expected, actual, difference */

typedef struct ReportPicture {
    uint8_t *data; /* a PNG file, or NULL */
    size_t size;
} ReportPicture;

typedef struct Report {
    const Regression *regression;
    const char *folder;                      /* of the report, as given */
    ReportPicture (*pictures)[REPORT_KINDS]; /* [frames] */
    int pictures_left_out;                   /* frames whose pictures did not fit */
    ReportLink *links;                       /* [runs], to the page of each that differs; empty: no page */
    int runs_left_out;                       /* whose page did not fit */
} Report;

/* The parts of ReportResults; `report` is a Report. */
ReportCase report_case(const void *report, int i);
void report_write_page(FILE *file, const void *report);
void report_write_json(FILE *file, const void *report);
