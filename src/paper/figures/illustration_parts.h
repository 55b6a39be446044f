/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the illustrations have in common; each is in illustration_NAME.c. */
#pragma once
#include "scene/scene.h"
#include "sketch/page_width.h"
#include "sketch/sketch.h"

enum { CAPTION_SIZE = 800 };

typedef enum IllustrationScene { SCENE_SINGLE, SCENE_STACK, SCENE_PYRAMID, ILLUSTRATION_SCENES } IllustrationScene;

typedef struct Illustration {
    double width, height; /* mm */
    /* Draws into an empty sketch of that size, and writes a caption: one line of text. */
    bool (*draw)(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error);
} Illustration;

extern const Illustration illustration_loop, illustration_narrow_phase, illustration_data, illustration_scenes;
