/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run while it is read from CSV. Part of csv_run. */
#pragma once
#include "trajectory/csv_head.h"
#include "trajectory/csv_rows.h"
#include "trajectory/csv_run.h"

typedef struct CsvImport {
    const char *path;
    size_t size; /* of the text */
    const CsvRunOptions *options;
    CsvRunNotes *notes;
    CsvHead head;
    CsvRows rows;
    int64_t count;                /* rows */
    int64_t first, last;          /* frames of the file */
    double first_time, last_time; /* of these frames, s */
    int *row_counts;              /* of each body */
    Trajectory *run;
} CsvImport;

void csv_import_note(CsvRunNotes *notes, const char *format, ...) PRINTF_LIKE(2, 3);

/* Index of the state of a body in a frame of the run. */
static inline size_t csv_import_place(const Trajectory *run, int64_t frame, int body) {
    return (size_t)frame * (size_t)run->bodies + (size_t)body;
}

/* Completes the bodies once all rows are read: sizes, which are static, poses of static bodies in frames without their row.
   False with error set if a body is missing between two of its frames. */
bool csv_import_finish_bodies(CsvImport *import, Error *error);
