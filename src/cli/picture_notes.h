/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Notes on standard error about pictures that may not show what their user expects. */
#pragma once
#include "cli/panels.h"
#include "render/moments.h"

/* If the runs are of different scenes. A run without a scene_hash is of an unknown scene, and not compared. */
void note_different_scenes(const Trajectory *const *runs, int count);

/* If the frames do not contain the impact, -1 for none, around which they are to be slow. */
void note_missing_impact(const MomentPlan *plan, int impact);

/* If the folder has pictures or runs that are not of the sequence, and not inputs of it. False if it cannot be read. */
bool note_foreign_files(const char *directory, const RenderResult *result, const Panels *panels, Error *error);
