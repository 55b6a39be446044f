/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs in a picture. Runs are read from .npz, or simulated from a scene, by the engine and pair-net unless methods
   are given. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "cli/options.h"
#include "pictures/picture.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdbool.h>

typedef struct Panels {
    int count;
    Trajectory *runs[RENDER_PANELS_MAX];
    const char *inputs[RENDER_PANELS_MAX]; /* the file of each run, or its scene's */
} Panels;

/* What a CommandSpec says of such inputs. T is the command's Options, with inputs[RENDER_PANELS_MAX] and
   input_count. */
#define PANELS_INPUTS(T)                                             \
    .input = {.value = "RUN_OR_SCENE...",                            \
              .needed = "a run (.npz) or a scene (.yaml) is needed", \
              OPTION_PATHS(T, inputs, input_count)},                 \
    .inputs = {1, RENDER_PANELS_MAX, "panel"}

/* The option --method of commands that show runs: by what the scenes among the inputs are simulated. */
typedef struct PanelMethods {
    const char *texts[RENDER_PANELS_MAX];
    int count; /* 0: the command's default */
} PanelMethods;

#define OPTION_METHODS(T, member, defaults)                                                          \
    "--method", 'm', "NAME[:KEY=VALUE,...]",                                                         \
        "Simulate the scene by this method, for a panel of its own (may be repeated; " defaults ")", \
        OPTION_METHOD_TEXTS(T, member.texts, member.count)

/* Settings need exactly one scene among the inputs, methods one at least. After an error, panels_free frees what was
   loaded before it. */
bool panels_load(Panels *panels, const char *const *inputs, int input_count, const SceneSettings *set,
                 const PanelMethods *methods, Error *error);

/* Adds a run of the scene file by each of the methods. */
bool panels_add_scene(Panels *panels, const char *input, const SceneSettings *set, const PanelMethods *methods,
                      Error *error);
void panels_free(Panels *panels);

/* Simulates a scene with a method, with a progress bar, and adds the run. Errors name `input`. */
bool panels_add_run(Panels *panels, const Scene *scene, const char *method_name, const char *input, Error *error);

/* 1920 x 1080, all frames, one process per core, the descriptions of all methods. */
RenderOptions render_defaults(const char *directory);

/* A note if the runs are of different scenes. A run without a scene_hash is of an unknown scene, and not compared. */
void note_different_scenes(const Trajectory *const *runs, int count);
