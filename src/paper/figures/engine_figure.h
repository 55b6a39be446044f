/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The four figures, each in a file of its own (src/figure/figure_NAME.c). */
#pragma once
#include "scene/scene.h"
#include "sketch/page_width.h"
#include "sketch/sketch.h"

enum { CAPTION_SIZE = 800 };

typedef enum EngineScene { SCENE_SINGLE, SCENE_STACK, SCENE_PYRAMID, ENGINE_SCENES } EngineScene;

typedef struct EngineFigure {
    double width, height; /* mm */
    /* Draws into an empty sketch of that size, and writes a caption: one line of plain text. */
    bool (*draw)(Sketch *sketch, Scene *const scenes[ENGINE_SCENES], char caption[CAPTION_SIZE], Error *error);
} EngineFigure;

extern const EngineFigure figure_loop, figure_narrow_phase, figure_data, figure_scenes;
