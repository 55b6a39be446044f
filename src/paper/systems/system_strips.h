/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strips: six moments of a held-out launch, the engine above, a system below; and a page of all runs. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "picture/render_options.h"

#include <stdbool.h>

enum { STRIP_SCENES = 2, STRIP_SYSTEMS_MAX = RENDER_PANELS_MAX - 1 };

extern const char *const strip_scene_names[STRIP_SCENES + 1]; /* stack, pyramid, NULL */

struct PaperSystem;

/* Runs the scenes of the folder `scenes` and draws folder/strip-NAME-SCENE.png, .svg and .txt, a caption of one line, for
   each system; and folder/strip-SCENE.html, a page that plays the engine's run beside those of all systems
   (player/player.h). systems: at most STRIP_SYSTEMS_MAX, ended by NULL. quick: shorter runs. The folder must exist. False with error set if a scene cannot
   be read or a run fails; ERROR_INTERRUPTED if progress, which may be NULL, requests a stop. */
bool system_strips_draw(const struct PaperSystem *const *systems, const char *scenes, bool quick, const char *folder,
                        const Progress *progress, Error *error);
