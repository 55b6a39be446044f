/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs that a picture shows: read from .npz, or made from a scene by the engine and the scene's networks. */
#pragma once
#include "cli/options.h"
#include "common/error.h"
#include "render/render.h"
#include "scene/scene.h"
#include "trajectory/trajectory.h"

typedef struct Panels {
    int count;
    Trajectory *runs[RENDER_PANELS_MAX];
} Panels;

/* Settings are for one scene: refused where there is none, or a second. What has been loaded before an error is freed by
   panels_free, too. */
bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SetOptions *set, Error *error);
void panels_free(Panels *panels);

/* Adds the run of a scene by a method, with a bar of progress; `input` is what it came from, for errors. */
bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error);

/* Writes each run as directory/SCENE-METHOD.npz; a second one of that name gets -2 and so on. */
bool panels_store(const Panels *panels, const char *directory, Error *error);
