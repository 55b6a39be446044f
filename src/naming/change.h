/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a region of differing pixels shows in twinbox's own pictures. */
#pragma once
#include "image/regions.h"

enum { CHANGES_MAX = 12 };

typedef enum ChangeSubject {
    SUBJECT_BODY,   /* dynamic */
    SUBJECT_BOMB,   /* the body that strikes */
    SUBJECT_FIXED,  /* a static body */
    SUBJECT_GROUND, /* the only static body */
    SUBJECT_BODIES, /* several; `body` is their number */
    SUBJECT_HEADER,
    SUBJECT_CAPTION,
    SUBJECT_AXIS,
    SUBJECT_LEGEND,
    SUBJECT_TIMELINE,
    SUBJECT_MARKS,      /* contacts, arrows, trails or outlines over a panel */
    SUBJECT_BACKGROUND, /* of a panel: grid and empty space */
    SUBJECT_PAGE        /* outside all panels and texts */
} ChangeSubject;

typedef enum ChangeKind {
    CHANGE_OTHER, /* none of the following */
    CHANGE_MOVED,
    CHANGE_COLOUR,
    CHANGE_LINE_WIDTH,
    CHANGE_APPEARED,
    CHANGE_DISAPPEARED
} ChangeKind;

typedef struct Change {
    ChangeSubject subject;
    ChangeKind kind;
    int panel;        /* from 1; 0: of the whole picture, or the only panel */
    int body;         /* index, or number of bodies */
    double right, up; /* moved: pixels, in the picture */
    double turn;      /* moved: rad, counter-clockwise */
    bool by_states;   /* the states of this frame differ so; otherwise measured in the pixels */
    int64_t pixels;   /* differing */
} Change;

/* The changes of one frame, most pixels first in each panel, and its regions. */
typedef struct FrameChanges {
    ImageRegions regions;
    int count;
    Change list[CHANGES_MAX];                 /* [count] */
    int16_t region_change[IMAGE_REGIONS_MAX]; /* [regions.kept] the change that names it best; -1: unknown */
    int16_t region_others[IMAGE_REGIONS_MAX]; /* [regions.kept] number of further changes there */
} FrameChanges;

typedef struct ChangeText {
    char text[160];
} ChangeText;

/* "body 7 moved 0.4 px right", "caption of panel 2", "ground (body 0): colour" */
ChangeText change_words(const Change *change);

/* The same without amounts, equal for the same cause in several frames: "body 7 moved". */
ChangeText change_cause(const Change *change);

/* "12 x 9 pixels at (40, 31), 34 of them differ: body 7 moved 0.4 px right"; without changes only the first part. */
ChangeText region_words(const FrameChanges *changes, int region);

/* What region_words() has after the colon; empty: unknown. */
ChangeText region_name(const FrameChanges *changes, int region);
