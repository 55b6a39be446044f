/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs that show what happened in a cell of a stability map. */
#pragma once
#include "cli/panels.h"
#include "stability/stability_table.h"

/* The origin of a map's runs. */
typedef struct ClipMap {
    const char *name;                      /* as in maps.csv */
    const char *scene;                     /* path of the scene file */
    const char *x_parameter, *y_parameter; /* of the scene */
} ClipMap;

/* First the method that holds, if there is one, which is not the cell's own. */
typedef struct CellRuns {
    const MapCell *rows[2];
    int count;
    double dt; /* s, of a step */
    Panels panels;
} CellRuns;

enum { CELL_NOTE_SIZE = 160 };

/* Runs the cell's method and the first one that holds there, until three seconds after the frame that decided the verdict, at
   most 60 frames per second. The runs have the verdicts of the table. `progress` NULL: each run has a bar. Errors name
   `input`. cell_runs_free() also after a failure. */
bool cell_runs_make(CellRuns *runs, const ClipMap *map, const MapTable *table, const MapCell *cell, const char *input,
                    const Progress *progress, Error *error);
void cell_runs_free(CellRuns *runs);

/* "falls at 4.22 s (0.53 m, body 7)" */
void cell_note(char note[CELL_NOTE_SIZE], const MapCell *cell, double dt);
