/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text entries of a picture's PNG file that state its origin. No date: the same picture gives the same file. */
#pragma once
#include "image/image.h"
#include "picture/picture.h"

enum {
    FRAME_TEXTS_MAX = 6,
    FRAME_METHODS_SIZE = RENDER_PANELS_MAX * (TRAJECTORY_NAME_SIZE + 3),
    FRAME_STATES_SIZE = RENDER_PANELS_MAX * 20
};

/* `entries` point into this struct. */
typedef struct FrameTexts {
    char methods[FRAME_METHODS_SIZE], frame[16], part[16], states[FRAME_STATES_SIZE];
    ImageText entries[FRAME_TEXTS_MAX];
    int count;
} FrameTexts;

/* Fills in Scene, Method, Frame, State (all panels joined) and Software; for interpolated pictures also "Part", for
   cards "Card". */
void frame_texts_fill(FrameTexts *texts, const Picture *picture, Moment moment);

/* The interpolated position, as "1/4". */
void frame_part_text(char *text, size_t size, Moment moment);
