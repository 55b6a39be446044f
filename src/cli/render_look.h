/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of what pictures show beside the bodies, as a child of a command's own. */
#pragma once
#include "cli/options.h"
#include "cli/panels.h"

typedef struct RenderLookOptions {
    const char *compare, *show, *camera, *theme, *costs;
    char cost_texts[RENDER_PANELS_MAX][64];
} RenderLookOptions;

extern const struct argp render_look_argp; /* its input: RenderLookOptions */

/* From the texts of the options to a look; its costs stay empty. */
bool render_look_read(const RenderLookOptions *options, RenderLook *look, Error *error);

/* Refuses what look_check() does, and takes the costs of the panels from the CSV that the options name: of their scene, in
   closed loop, at the impact. A run that it does not have stays without; a file that has none of them is refused. What
   the look then points to lives in `options`. */
bool render_look_apply(RenderLookOptions *options, RenderLook *look, const Panels *panels, Error *error);
