/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of a stability study, drawn from its tables. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

/* Reads folder/stability.csv and folder/maps.csv (stability/stability_table.h) and draws, as .png, .svg
   and a caption .txt of one line,
     map-NAME   one per map: a panel per method, a tile per cell (stability/stability_map.h); in the .svg, tiles link to
                the cells' clips, whether these exist or not
     borders    how far each method holds in each study (stability/stability_borders.h)
   into the folder. Readable for the colour-blind, in grey and in black and white. The same tables give the same files.

   A table without rows gives no figure. An invalid table is an error "path:line:column: error: text" before anything is
   drawn. ERROR_INTERRUPTED if progress, which may be NULL, requests a stop;
   figures already drawn stay. */
bool stability_figures_write(const char *folder, const Progress *progress, Error *error);
