/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of render for the look of its pictures, an argp child. */
#pragma once
#include "cli/options.h"
#include "cli/panels.h"

typedef struct RenderLookOptions {
    const char *compare, *show, *camera, *theme, *costs;
    char cost_texts[RENDER_PANELS_MAX][64];
} RenderLookOptions;

extern const struct argp render_look_argp; /* its input: RenderLookOptions */

/* Parses the options into a look. Costs stay empty. */
bool render_look_read(const RenderLookOptions *options, RenderLook *look, Error *error);

/* Refuses what look_check() refuses. Takes the costs of the panels from the CSV that the options name: the same scene,
   closed loop, at the impact. A run without a row has no cost; a file without any row for the runs is refused. The look
   then points into `options`. */
bool render_look_apply(RenderLookOptions *options, RenderLook *look, const Panels *panels, Error *error);
