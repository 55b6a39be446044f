/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs in a picture: read from .npz, or simulated from a scene with the engine and with pair-net. */
#pragma once
#include "cli/options.h"
#include "common/error.h"
#include "render/render.h"
#include "scene/scene.h"
#include "trajectory/trajectory.h"

typedef struct Panels {
    int count;
    Trajectory *runs[RENDER_PANELS_MAX];
    const char *inputs[RENDER_PANELS_MAX]; /* the file of each run, or its scene's */
} Panels;

/* What a CommandSpec says of such inputs. T is the command's Options, with inputs[RENDER_PANELS_MAX] and input_count. */
#define PANELS_INPUTS(T)                                             \
    .input = {.value = "RUN_OR_SCENE...",                            \
              .needed = "a run (.npz) or a scene (.yaml) is needed", \
              OPTION_PATHS(T, inputs, input_count)},                 \
    .inputs = {1, RENDER_PANELS_MAX, "panel"}

/* Settings need exactly one scene among the inputs. After an error, panels_free frees what was loaded before it. */
bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set, Error *error);
void panels_free(Panels *panels);

/* Simulates a scene with a method, with a progress bar, and adds the run. Errors name `input`. */
bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error);

/* The same with another progress; NULL: the bar. */
bool panels_add_watched(Panels *panels, const Scene *scene, const char *method_name, const char *input,
                        const Progress *progress, Error *error);

/* Writes each run into the directory, under its trajectory_file_name(). */
bool panels_store(const Panels *panels, const char *directory, Error *error);
