/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stability map: the verdict of every method in every cell of a grid; a part of the study (study_parts.h). */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

typedef struct StabilityGrid {
    const StabilityMap *map;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
    bool quick; /* the smaller grid */
} StabilityGrid;

/* Writes the rows of the table "maps", ordered by method, y, x. Omits methods that do not apply to the scene, methods
   that set their own number of sweeps if the map scans it, and the reference, by which runs are judged. `grid` is a
   StabilityGrid. */
bool stability_grid_write(void *grid, FILE *lines, const Progress *progress, Error *error);
