/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What twinbox's own pictures show where: the view of manifest.json, and the runs that it names.

     ShownFolder *folder = shown_find(&shown, "out/frame_000003.png", error);
     shown_run(folder, folder->view.panels[0].run, &run, error); */
#pragma once
#include "base/base.h"
#include "runs/trajectory.h"

/* Its panels with their cameras, and the rectangles of texts and curves, from the manifest.json that render leaves
   beside the pictures. Pixels, y down. */

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

/* What the pictures of a folder show: the view from manifest.json, and the runs that it names, each read when it is
   first asked for, and kept. */

typedef struct ShownFolder {
    char *path;                         /* with its slash; empty for the current folder */
    FrameView view;                     /* width 0: unknown */
    int run_count;                      /* read, or tried */
    const char *names[VIEW_PANELS_MAX]; /* of the files of runs, in the view */
    Trajectory *runs[VIEW_PANELS_MAX];  /* NULL: cannot be read */
    struct ShownFolder *next;
} ShownFolder;

typedef struct Shown {
    ShownFolder *first;
} Shown;

/* The folder of a picture. Thread-safe. NULL with error set if the system fails; a folder that has no readable manifest
   has no view. */
ShownFolder *shown_find(Shown *shown, const char *picture, Error *error);

/* *run: the run of this file name in the folder, a name of its view; NULL if it cannot be read. Thread-safe. False with
   error set if the system fails. */
bool shown_run(ShownFolder *folder, const char *name, const Trajectory **run, Error *error);
void shown_free(Shown *shown);
