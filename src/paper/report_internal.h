/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the plots share, and what the illustrations share. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "engine/engine.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/paper_tables.h"
#include "scenes/scenes.h"

#include <stddef.h>

/* What the illustrations have in common; each is in illustration_NAME.c, that of the narrow phase with the drawing of
   all. */

enum { CAPTION_SIZE = 800 };

typedef enum IllustrationScene { SCENE_SINGLE, SCENE_STACK, SCENE_PYRAMID, ILLUSTRATION_SCENES } IllustrationScene;

typedef struct Illustration {
    double width, height; /* mm */
    /* Draws into an empty sketch of that size, and writes a caption: one line of text. */
    bool (*draw)(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error);
} Illustration;

extern const Illustration illustration_loop, illustration_narrow_phase, illustration_data, illustration_scenes;

/* The plots of paper_report.h, from their tables. The page's width stays 0 if a table has no rows to show. False with
   error set if memory is short. */
typedef bool PlotWrite(const CsvTable *table, PlotPage *page, Error *error);
PlotWrite plot_factors, plot_closed_loop, plot_transfer;

/* A run of the engine, step by step, for figures that need a step's contact problem. */

typedef struct EngineRun {
    const Scene *scene; /* with the launch; owned by the caller */
    World *world;
    Stepper *stepper;
    int frame; /* of the last step; 0: no step yet */
    PhaseTracker tracker;
} EngineRun;

/* On failure nothing is to be ended. */
bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error);
bool engine_run_step(EngineRun *run, Error *error);
void engine_run_end(EngineRun *run);

/* Steps until the bomb first touches a movable box. ERROR_INPUT if it never does. */
bool engine_run_to_touch(EngineRun *run, Error *error);

/* The box of a body as collision detection used it in the last step. */
Box engine_run_box(const EngineRun *run, int body);
