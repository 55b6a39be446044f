/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs and scenes as files of other programs:

     CsvRunNotes notes;
     Trajectory *run = csv_run_read("box2d.csv", &(CsvRunOptions){.name = "box2d"}, &notes, &error); */
#pragma once
#include "base/base.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

/* Runs as CSV: comments with what does not change, then a row for each body in each frame. README.md has the format. */

typedef struct CsvRunOptions {
    const char *name;  /* scene and method where the file does not state them */
    const char *sizes; /* CSV of body,width,height and perhaps static; NULL: the file's comments have the sizes */
    float dt;          /* s; 0: the file states it */
    bool degrees;      /* angles and angular velocities of the file are in degrees */
    bool as_trace;     /* csv_trace_read() */
} CsvRunOptions;

/* What the reader assumed: a line each. */
enum { CSV_RUN_NOTES_MAX = 16, CSV_RUN_NOTE_SIZE = 200 };
typedef struct CsvRunNotes {
    int count;
    char lines[CSV_RUN_NOTES_MAX][CSV_RUN_NOTE_SIZE];
} CsvRunNotes;

/* path "-": standard input.
   NULL with error set ("path:line:column: error: ..."): a frame without rows, a body that is missing in a frame between
   two of its own, two rows of a body in a frame, bodies without a size or without rows, anything that is not a finite
   number, times that are not equidistant, or a file above 1 GiB. */
Trajectory *csv_run_read(const char *path, const CsvRunOptions *options, CsvRunNotes *notes, Error *error);

/* Reads what another program states of its run, to compare it: poses of bodies of any shape, or hashes of their states.
   Frames and bodies keep the numbers of the file, and may be absent; sizes and the time step may be unknown; NaN and
   infinite numbers are states. For comparisons only: `there` is set. */
Trajectory *csv_trace_read(const char *path, Error *error);

/* Writes what csv_run_read() gives back bit by bit: all but contacts and verdict. */
bool csv_run_write(const Trajectory *run, const char *path, Error *error);

/* One object, without what is unknown: README.md lists its keys. */
bool json_run_write(const Trajectory *run, const char *path, Error *error);

/* Writes the scene as JSON, with patterns and parameters written out: src/runs/README.md lists the keys. */
bool scene_flat_write(const Scene *scene, const char *path, Error *error);
