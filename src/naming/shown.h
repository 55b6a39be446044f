/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the pictures of a folder show, for the naming of differences: the view from manifest.json, and the runs that it
   names. Read when a picture of the folder first differs, and kept. */
#pragma once
#include "naming/view.h"

#include <stdbool.h>

typedef struct ShownFolder {
    char *path; /* with its slash; empty for the current folder */
    View view;  /* width 0: unknown */
    int run_count;
    const char *names[VIEW_PANELS_MAX]; /* of the files of runs, in the view */
    Trajectory *runs[VIEW_PANELS_MAX];  /* NULL: cannot be read */
    struct ShownFolder *next;
} ShownFolder;

typedef struct Shown {
    ShownFolder *first;
} Shown;

/* The folder of a picture. Thread-safe. NULL if out of memory; a folder that has no readable manifest or run has no view
   or run. */
const ShownFolder *shown_find(Shown *shown, const char *picture);

/* The run of this file name that the view names, or NULL. */
const Trajectory *shown_run(const ShownFolder *folder, const char *name);
void shown_free(Shown *shown);
