/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places labels beside marks without covering anything. All lengths in mm on the page.

     label_add_box(&field, mark);
     if (label_place(&field, x, y, 1, width, height, false, &place)) ... draw the text in `place` */
#pragma once
#include "base/base.h"
#include "figures/sketch.h"

typedef struct PageBox {
    double left, bottom, right, top;
} PageBox;

typedef struct Segment {
    double x0, y0, x1, y1;
} Segment;

enum { LABEL_MAX_BOXES = 1024, LABEL_MAX_SEGMENTS = 2048 };

/* Everything already drawn. */
typedef struct LabelField {
    PageBox frame; /* labels stay inside */
    int box_count, segment_count;
    int crossable;                        /* the first boxes, which lines to labels may cross if they may cross lines */
    PageBox boxes[LABEL_MAX_BOXES];       /* marks and labels, never covered */
    Segment segments[LABEL_MAX_SEGMENTS]; /* lines, crossed only by labels that must be placed */
} LabelField;

/* Beyond the limits boxes and segments are ignored, and labels may cover them. */
void label_add_box(LabelField *field, PageBox box);
void label_add_segment(LabelField *field, Segment segment);

/* Finds the box for a label of this size near (x, y), at least `distance` away: the nearest that covers no box and
   crosses no line. False if there is none; with `must`, the one that crosses the fewest lines. Adds the box to the
   field. */
bool label_place(LabelField *field, double x, double y, double distance, double width, double height, bool must,
                 PageBox *place);

/* A label of this size for the mark at (x, y), whose radius is `clear`. */
typedef struct LabelWish {
    double x, y, clear;
    double nearest, farthest; /* mm, from the mark to the label */
    double width, height;
    bool left;   /* try the left before the right */
    bool across; /* the line to the label may cross others, and crossable boxes */
    /* a line from beside ends at the lower corner and goes on below, not to be read as a number's minus sign */
    bool shelf;
} LabelWish;

/* Finds the nearest free place for a label, to which a straight line from its mark crosses nothing that is drawn;
   *leader is that line, from the mark's edge to the label, and *led whether it is long enough to be drawn. Adds label
   and line to the field. False if there is no place. */
bool label_place_led(LabelField *field, const LabelWish *wish, PageBox *place, Segment *leader, bool *led);

/* From a mark to its label, and along below it if the mark is beside it (label_place_led). */
void draw_leader(Sketch *sketch, const Segment *leader, const PageBox *label, const Pen *pen);
