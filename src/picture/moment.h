/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a picture of a video shows: a stored frame of the runs, a time between two, or a card of words. A video is a
   list of moments; a sequence without slow motion, hold and cards is the stored frames in their order. */
#pragma once

typedef enum MomentKind {
    MOMENT_STORED,  /* a frame as it is */
    MOMENT_BETWEEN, /* poses between a frame and the next */
    MOMENT_TITLE,   /* a card before the run */
    MOMENT_END      /* a card after it */
} MomentKind;

typedef struct Moment {
    MomentKind kind;
    int frame;   /* shown, or the one before */
    double part; /* between: of the way to the next frame, 0 < part < 1; else 0 */
    int slow;    /* times slower than the run; 1: as fast as it */
} Moment;

static inline Moment moment_stored(int frame) { return (Moment){MOMENT_STORED, frame, 0, 1}; }
