/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stability map: the verdict of every method in every cell of a grid. */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

#include <stdio.h>

typedef struct StabilityGrid {
    const StabilityMap *map;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
    bool quick; /* the smaller grid */
} StabilityGrid;

/* What the pieces of a map have in common. */
typedef struct GridContext {
    const StabilityGrid *grid;
    Scene *typical; /* with default parameters */
    int x_count, y_count;
    double x[BORDER_POINTS_MAX], y[BORDER_POINTS_MAX];
    int method_count;
    const Contender **methods; /* [method_count] that apply to the scene */
} GridContext;

/* The number of cells. */
int stability_grid_cells(const StabilityMap *map, bool quick);

/* stability_grid_end() also after a failure. */
bool stability_grid_begin(GridContext *context, const StabilityGrid *grid, Error *error);
void stability_grid_end(GridContext *context);

/* Judges the cells first .. end - 1, row by row from the least y, and writes their rows of the table "maps", with a section
   for each of grid->methods (study/piece_tables.h). Omits methods that do not apply to the scene, methods that set their own
   number of sweeps if the map scans it, and the reference, by which runs are judged. */
bool stability_grid_write(const GridContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error);
