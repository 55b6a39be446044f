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
    int frame; /* the frame shown, or the one before */
    int part,
        parts;   /* MOMENT_BETWEEN: position between this frame and the next, 0 < part < parts; otherwise part is 0, and
                        parts > 1 if the pictures beside it may be interpolated */
    double slow; /* times slower than real time; below 1: faster */
} Moment;

static inline Moment moment_stored(int frame) { return (Moment){MOMENT_STORED, frame, 0, 1, 1}; }

/* The position between the frame and the next, 0 <= fraction < 1. */
static inline double moment_fraction(Moment moment) { return (double)moment.part / moment.parts; }
