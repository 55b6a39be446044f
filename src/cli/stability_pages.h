/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of stability maps: each plays what happened in a cell beside the first method that holds there. */
#pragma once
#include "cli/stability_runs.h"

#include <stdint.h>

typedef struct StabilityPages {
    const char *folder;  /* of maps.csv */
    const ClipMap *maps; /* [map_count] */
    int map_count;
} StabilityPages;

/* Runs cells again (stability/map_pages.h tells which) and writes folder/pages/MAP-METHOD-X_Y.html, map_pages.csv and
   stability.html. A page begins six seconds before the verdict was decided. key: of the study (study/study_key.h). Prints how
   many pages there are, and what was left out. */
bool stability_pages_write(const StabilityPages *pages, uint64_t key, Error *error);
