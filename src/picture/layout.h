/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a picture of a given size. */
#pragma once
#include "gl/font.h"
#include "picture/render_options.h"

typedef struct Layout {
    Font scene, status, title, method, axis; /* without glyphs if the picture is too small for text */
    int columns, rows;
    int left, right;                /* inner edges of the margins */
    int header_baseline;            /* of the first line of the title */
    int header_lines, header_pitch; /* number of its lines, and the distance between them */
    int title_rise;                 /* from the top of a panel up to the baseline of its title */
    int axis_drop;                  /* from the bottom of a panel down to the baseline of its axis */
    int tick;                       /* length of a tick at the axis */
    int hairline;                   /* the thinnest line */
    Rect area;                      /* that the panels share, with the lines between them */
    int gap, row_gap;               /* between panels */
    Rect panels[RENDER_PANELS_MAX]; /* all of equal size */
    int width, height;              /* of the picture */
    int legend_baseline;            /* of the first row; 0: no legend */
    int legend_rows, legend_pitch;  /* number of rows, and the distance between them */
    int key_baseline;               /* of the key above the timeline */
    Rect timeline;                  /* the curves; empty: none */
} Layout;

/* Rows above and below the panels. */
typedef struct LayoutRows {
    int title; /* lines of the header, at least 1 */
    int legend;
    bool timeline;
} LayoutRows;

/* Columns of the grid of 1 to RENDER_PANELS_MAX panels that a picture has unless its scene needs another. */
int layout_columns(int width, int height, int panels);

/* The panels fill their area. */
Layout layout_make(int width, int height, int panels, int columns, LayoutRows rows);

/* Makes the panels smaller, in the middle of their area; width and height in pixels. */
void layout_shrink_panels(Layout *layout, int panels, int width, int height);
