/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What compare names in twinbox's own pictures: the view of a frame, bodies, texts, regions. */
#pragma once
#include "base/base.h"
#include "regression/compare.h"
#include "runs/trajectory.h"

#include <stdbool.h>

/* What a region of differing pixels shows in twinbox's own pictures. */

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
    SUBJECT_PAGE,       /* outside all panels and texts */
    SUBJECT_CONTENT     /* of a picture of which nothing is known */
} ChangeSubject;

typedef enum ChangeKind {
    CHANGE_OTHER, /* none of the following */
    CHANGE_MOVED,
    CHANGE_COLOUR,
    CHANGE_APPEARED,
    CHANGE_DISAPPEARED,
    CHANGE_REPLACED, /* by other content */
    CHANGE_NOISE,    /* small or scattered differences, or only along edges */
    CHANGE_UNSURE    /* looked at, and none of these */
} ChangeKind;

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

/* What twinbox's own picture shows where: its panels with their cameras, and the rectangles of texts and curves. Read
   from the manifest.json that render leaves beside the pictures. Pixels, y down. */

enum { VIEW_PANELS_MAX = 6, VIEW_PARTS_MAX = 64, VIEW_NAME_SIZE = 256 };

typedef struct ViewRect {
    int left, top, right, bottom; /* right and bottom are exclusive */
} ViewRect;

/* A point (x, y) in metres is at pixel (rect.left + left + scale * x, rect.top + top - scale * y). */
typedef struct ViewPanel {
    ViewRect rect;
    double scale, left, top;
    char run[VIEW_NAME_SIZE]; /* file name of the run whose boxes it shows filled */
    int outline_count;
    char outlines[VIEW_PANELS_MAX][VIEW_NAME_SIZE]; /* of those whose boxes are outlines above the others */
} ViewPanel;

typedef enum ViewPartKind { VIEW_HEADER, VIEW_CAPTION, VIEW_AXIS, VIEW_LEGEND, VIEW_TIMELINE } ViewPartKind;

typedef struct ViewPart {
    ViewPartKind kind;
    int panel; /* from 1; 0: of the whole picture */
    ViewRect rect;
} ViewPart;

typedef struct FrameView {
    int width, height; /* of the picture; 0: unknown, and then nothing else is set */
    int panel_count, part_count;
    ViewPanel panels[VIEW_PANELS_MAX];
    ViewPart parts[VIEW_PARTS_MAX];
    bool marks;   /* contacts, arrows, trails or ghosts may be drawn over the bodies */
    bool follows; /* the camera moves from frame to frame, and the panels' cameras are those of no certain frame */
} FrameView;

/* Reads the view from a manifest. False with error set if the file is missing, damaged, or has no view. Not thread-safe
   (base/json.h). */
bool view_read(FrameView *view, const char *path, Error *error);

/* How two views differ: "the camera differs: 36 and 27.5 pixels/m". Empty: they are equal. Parts do not count. */
typedef struct ViewText {
    char text[192];
} ViewText;
ViewText view_difference(const FrameView *expected, const FrameView *actual);

/* What the pictures of a folder show, for the naming of differences: the view from manifest.json, and the runs that it
   names. Read when a picture of the folder first differs, and kept. */

typedef struct ShownFolder {
    char *path;     /* with its slash; empty for the current folder */
    FrameView view; /* width 0: unknown */
    int run_count;
    const char *names[VIEW_PANELS_MAX]; /* of the files of runs, in the view */
    Trajectory *runs[VIEW_PANELS_MAX];  /* NULL: cannot be read */
    struct ShownFolder *next;
} ShownFolder;

typedef struct Shown {
    ShownFolder *first;
} Shown;

/* The folder of a picture. Thread-safe. NULL with error set if the system fails; a folder that has no readable manifest
   or run has no view or run. */
const ShownFolder *shown_find(Shown *shown, const char *picture, Error *error);

/* The run of this file name that the view names, or NULL. */
const Trajectory *shown_run(const ShownFolder *folder, const char *name);
void shown_free(Shown *shown);
