/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the file of a picture tells of its origin. No date: the same picture gives the same file. */
#pragma once
#include "image/image.h"
#include "picture/picture.h"

enum {
    FRAME_TEXTS_MAX = 6,
    FRAME_METHODS_SIZE = RENDER_PANELS_MAX * (TRAJECTORY_NAME_SIZE + 3),
    FRAME_STATES_SIZE = RENDER_PANELS_MAX * 20
};

/* The entries point into it. */
typedef struct FrameTexts {
    char methods[FRAME_METHODS_SIZE], frame[16], part[16], states[FRAME_STATES_SIZE];
    ImageText entries[FRAME_TEXTS_MAX];
    int count;
} FrameTexts;

/* All panels joined: Scene, Method, Frame, State, Software; "Part" of the way to the next frame, or which "Card" it is. */
void frame_texts_fill(FrameTexts *texts, const Picture *picture, Moment moment);

/* "1/4" */
void frame_part_text(char *text, size_t size, Moment moment);
