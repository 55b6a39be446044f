/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where everything stands in a picture of a given size. */
#pragma once
#include "gl/font.h"
#include "picture/render_options.h"

typedef struct Layout {
    Font scene, status, title, method, axis; /* without glyphs where the picture is too small for text */
    int columns, rows;
    int left, right; /* the margins' inner edges */
    int header_baseline;
    int title_rise;                 /* from the top of a panel up to the baseline of its title */
    int axis_drop;                  /* from the bottom of a panel down to the baseline of its axis */
    int tick;                       /* length of a tick at the axis */
    int hairline;                   /* thickness of the thinnest line */
    Rect panels[RENDER_PANELS_MAX]; /* all of one size */
    int width, height;              /* of the picture */
    int legend_baseline;            /* of its first row; 0: no legend */
    int legend_pitch;               /* from one of its rows to the next */
    int key_baseline;               /* of the words above the timeline */
    Rect timeline;                  /* its curves; empty: none */
} Layout;

/* Rows below the panels. */
typedef struct LayoutRows {
    int legend;
    bool timeline;
} LayoutRows;

Layout layout_make(int width, int height, int panels, LayoutRows rows);
