/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What differs between two of twinbox's own pictures: bodies, captions, axes.

     NamingScene scene = {.view = &view, .runs = {{expected_run, actual_run}}, .frame = 3};
     naming_find(&scene, levels, &difference, &changes, error);
     puts(region_words(&changes, 0).text);      ... "12 x 9 pixels at (40, 31), ...: body 7 moved 0.4 px right" */
#pragma once
#include "base/base.h"
#include "regression/image_compare.h"
#include "regression/view.h"
#include "runs/trajectory.h"

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

typedef enum ChangeKind { CHANGE_OTHER, CHANGE_MOVED, CHANGE_APPEARED, CHANGE_DISAPPEARED } ChangeKind;

typedef struct Change {
    ChangeSubject subject;
    ChangeKind kind;
    int panel;        /* from 1; 0: of the whole picture, or the only panel */
    int body;         /* index, or number of bodies */
    double right, up; /* moved: pixels, in the picture */
    double turn;      /* moved: rad, counter-clockwise */
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

/* What both pictures show. */
typedef struct NamingScene {
    const FrameView *view;                      /* of both pictures */
    const Trajectory *runs[VIEW_PANELS_MAX][2]; /* per panel: expected, actual; NULL: unknown; may be the same */
    const Trajectory
        *outlines[VIEW_PANELS_MAX][VIEW_PANELS_MAX]; /* per panel: expected runs drawn as outlines, or NULL */
    int frame;                                       /* of the runs */
} NamingScene;

enum { NAMING_PIXELS_MAX = 20000000 }; /* larger pictures get no names */

/* Fills the changes, and the names of the regions, which must be set. levels[height, width], of the view's size: where
   pixels differ, as image_find_levels() gives them; their values are lost. difference: their bounds. False with error
   set if out of memory. */
bool naming_find(const NamingScene *scene, uint8_t *levels, const ImageDifference *difference, FrameChanges *changes,
                 Error *error);

typedef struct ChangeText {
    char text[160];
} ChangeText;

/* "body 7 moved 0.4 px right", "caption of panel 2", "ground (body 0) changed" */
ChangeText change_words(const Change *change);

/* The same without amounts, equal for the same cause in several frames: "body 7 moved". */
ChangeText change_cause(const Change *change);

/* "12 x 9 pixels at (40, 31), 34 of them differ by at most 90: body 7 moved 0.4 px right"; without a name only the
   first part. */
ChangeText region_words(const FrameChanges *changes, int region);

/* What region_words() has after the colon: a change, or "noise along edges" (antialias.h); empty: unknown. */
ChangeText region_name(const FrameChanges *changes, int region);
