/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs in a picture, and what their steps cost. Runs are read from .npz, or simulated from a scene, by the
   engine and pair-net unless methods are given. */
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

/* The same with another progress; NULL: the bar. */
bool panels_add_watched(Panels *panels, const Scene *scene, const char *method_name, const char *input,
                        const Progress *progress, Error *error);

/* Writes each run into the directory, under its trajectory_file_name(). */
bool panels_store(const Panels *panels, const char *directory, Error *error);

/* The time per step of each panel's method, for the captions. */

typedef struct PanelCosts {
    char texts[RENDER_PANELS_MAX][64];
} PanelCosts;

/* Reads the costs of the panels from a chart.csv: the same scene, closed loop, at the impact. A run without a row has
   no cost; a file without any row for the runs is refused. The look then points into `costs`. */
bool panel_costs_read(PanelCosts *costs, const char *path, const Panels *panels, RenderLook *look, Error *error);

/* The last frame of the longest panel. */
int panels_last_frame(const Panels *panels);
