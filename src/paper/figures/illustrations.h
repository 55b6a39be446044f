/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of the paper (Avatavului, Ifrim, Voncila 2023, figures 1 to 4), drawn from runs of this engine. */
#pragma once
#include "common/error.h"

/* Names of the figures in the paper's order, ended by NULL: loop (the stages of a step), narrow-phase (the contact of
   two boxes), data (how training data are made), scenes. */
extern const char *const illustration_names[];

/* Runs single.yaml, stack.yaml and pyramid.yaml of scenes_folder with the engine, and draws folder/NAME.png and .svg,
   as wide as a page (sketch/page_width.h). folder/NAME.txt is the caption with the numbers of the run: one line of
   text. The folder must exist. ERROR_INPUT where a scene cannot be read, has no bomb, or never shows what the figure is
   about. The renderer runs in this process and sets Mesa's environment variables (render/render.h). */
bool illustrations_draw(const char *scenes_folder, const char *folder, Error *error);
