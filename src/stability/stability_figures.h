/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of a stability study, from its two tables on disk. */
#pragma once
#include "common/error.h"

/* Reads folder/stability.csv and folder/maps.csv (stability/stability_table.h) and draws, as .png, .svg (chart/gnuplot.h)
   and a caption .txt of one line,
     map-NAME   each map: a panel a method, a tile a cell (stability/stability_map.h), which in the .svg is a link to the
                cell's clip, be it there or not yet
     borders    each study: how far each method holds (stability/stability_borders.h)
   into the folder. Told apart by the colour-blind, in grey and in black and white. The same tables give the same files.

   Of a table without rows there is none. A table that is not in order is refused with "path:line:column: error: text"
   before anything is drawn. ERROR_SYSTEM where gnuplot is missing or fails; figures already drawn stay. */
bool stability_figures_write(const char *folder, Error *error);
