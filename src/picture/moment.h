/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A moment is what one picture of a video shows: a stored frame, a time between two frames, or a card. A video is a
   list of moments; without slow motion, hold and cards these are the stored frames in order. */
#pragma once

typedef enum MomentKind {
    MOMENT_STORED,  /* a frame as stored */
    MOMENT_BETWEEN, /* poses interpolated between a frame and the next */
    MOMENT_TITLE,   /* a card before the run */
    MOMENT_END      /* a card after the run */
} MomentKind;

typedef struct Moment {
    MomentKind kind;
    int frame;       /* the frame shown, or the one before */
    double fraction; /* MOMENT_BETWEEN: position between this frame and the next, 0 < fraction < 1; otherwise 0 */
    int slow;        /* slow-motion factor; 1: real time */
} Moment;

static inline Moment moment_stored(int frame) { return (Moment){MOMENT_STORED, frame, 0, 1}; }
