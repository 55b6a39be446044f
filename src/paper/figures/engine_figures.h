/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of the paper (Avatavului, Ifrim, Voncila 2023, figures 1 to 4), drawn from runs of this engine. */
#pragma once
#include "common/error.h"

/* Names of the figures in the paper's order, ended by NULL: loop (one step and its stages), narrow-phase (which way two
   boxes touch), data (how training data are made), scenes. */
extern const char *const engine_figure_names[];

/* Runs single.yaml, stack.yaml and pyramid.yaml of scenes_folder by the engine, and draws folder/NAME.png and .svg, 174 mm
   wide. folder/NAME.txt is the caption with the figure's own numbers: one line of plain text. The folder must be there.
   ERROR_INPUT where a scene cannot be read, has no bomb, or shows nothing of what is to be drawn. Every file
   is whole or not there. The renderer draws in this process, and so sets
   Mesa's environment variables (render/render.h). */
bool engine_figures_draw(const char *scenes_folder, const char *folder, Error *error);
