/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a picture has its texts, axes and curves. Whatever is drawn outside the panels and their frames is in one of
   these parts. */
#pragma once
#include "picture/picture.h"

typedef enum PartKind { PART_HEADER, PART_CAPTION, PART_AXIS, PART_LEGEND, PART_TIMELINE } PartKind;

typedef struct Part {
    PartKind kind;
    int panel; /* captions and axes: the panel; otherwise -1 */
    Rect rect;
} Part;

/* Two axes and a caption for each panel, and one of each other kind. */
enum { PARTS_MAX = 3 * RENDER_PANELS_MAX + 3 };

/* The names in manifests, in the order of PartKind. */
extern const char *const part_names[];

/* Fills `parts` and returns their number; 0 in a picture too small for text and without a timeline. */
int parts_find(const Picture *picture, Part parts[PARTS_MAX]);
