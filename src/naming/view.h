/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What twinbox's own picture shows where: its panels with their cameras, and the rectangles of texts and curves. Read from
   the manifest.json that render leaves beside the pictures. Pixels, y down. */
#pragma once
#include "common/error.h"
#include "trajectory/trajectory.h"

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

typedef struct View {
    int width, height; /* of the picture; 0: unknown, and then nothing else is set */
    int panel_count, part_count;
    ViewPanel panels[VIEW_PANELS_MAX];
    ViewPart parts[VIEW_PARTS_MAX];
    bool marks;   /* contacts, arrows, trails or ghosts may be drawn over the bodies */
    bool follows; /* the camera moves from frame to frame, and the panels' cameras are those of no certain frame */
} View;

/* Reads the view from a manifest. False with error set if the file is missing, damaged, or has no view. Not thread-safe
   (json/json_read.h). */
bool view_read(View *view, const char *path, Error *error);

/* How two views differ: "the camera differs: 36 and 27.5 pixels/m". Empty: they are equal. Parts do not count. */
typedef struct ViewText {
    char text[192];
} ViewText;
ViewText view_difference(const View *expected, const View *actual);
