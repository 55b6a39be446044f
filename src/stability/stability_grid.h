/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One map of stability: the verdict on every method in every cell of a grid, as a part of a longer work
   (study_parts.h). */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

typedef struct StabilityGrid {
    const StabilityMap *map;
    const char *scenes; /* the folder above stability/ */
    const ContenderList *methods;
    bool quick; /* the smaller grid */
} StabilityGrid;

/* Writes the lines of the table "maps": by method, then y, then x, both ascending. Without the methods that do not go with
   the scene, without those that have their own number of iterations where these are scanned, and without the reference,
   by which runs are judged. `grid` is a StabilityGrid. */
bool stability_grid_write(void *grid, FILE *lines, const Progress *progress, Error *error);
