/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the look: rows and letters, thickness of lines, limits, and where the colour of a band changes; chosen
   by eye. C and the script of a page that plays runs have this one table: base/tools/embed.cmake makes constants of
   JavaScript of its lines. So each is a `static const` number that both languages write alike. Colours are in look.c;
   a page has them as data. */
#pragma once

/* Boxes. */

static const double CORNER = 0.11, OUTLINE = 0.045, BAND = 0.13, TARGET = 0.30; /* of a box's shorter side */
static const double MIN_OUTLINE = 1;                                            /* pixels */
static const double MIN_OUTLINED_SIDE = 5;                      /* pixels; a smaller box has no outline */
static const double MAX_CORNER = 0.009, MAX_OUTLINE = 0.0026;   /* of the shorter side of the panel */
static const double GHOST_OUTLINE = 0.0034;                     /* the same, of an outline drawn without its box */
static const double MIN_GHOST_OUTLINE = 1.6;                    /* pixels */
static const double MIN_SWATCH_OUTLINE = 2, SWATCH_OUTLINE = 8; /* pixels; the side of a sample over its outline */
static const double NESTED_TOTAL =
    1.2; /* overlay: the first outline is at most this many thicknesses thicker than the last */
static const double NESTED_STEP = 0.7; /* from one outline to the next, at most */
static const double FADE = 0.55;       /* share of the panel's colour in boxes behind outlines */
static const double TARGET_THIRD = 3;  /* radius of a target / thickness of its ring, and radius of its dot */
static const double TARGET_BAR = 7;    /* the radius / half the width of its bar */
static const double TARGET_BAR_HEIGHT = 0.3, TARGET_BAR_RISE = 1.2; /* half the bar's, and its middle's / the radius */

/* Boxes coloured by a distance: the band is a darker or a lighter shade of the box. */

static const int LIGHT_GREEN = 140; /* of 255: from here on a colour is light, as green dominates luminance */
static const double BAND_DARKER = 0.6,
                    BAND_LIGHTER = 0.7;   /* share of black in a light box's band, of white in a dark one's */
static const int SCALE_FIRST_DECADE = -3; /* the colour scale begins at 1 mm */
static const int SCALE_LAST_DECADE = 1;   /* and ends at 10 m at the latest */

/* Labels: upright text in the middle of a box, in a circle, so that its size does not depend on how the box is
   turned. */

static const double LABEL_CIRCLE = 0.85; /* diameter of the circle / the box's shorter side */
static const double LABEL_EMS = 0.64,
                    LABEL_CAP = 0.73;     /* width of a digit and height of capitals / size of the letters */
static const int LABEL_DIGITS = 2;        /* shorter texts have the size of one with so many */
static const double LABEL_MEASURED = 100; /* pixels, size of the letters of which the width of a name is known */
static const double LABEL_LEAST =
    9; /* pixels, size of the letters: the smallest that the font has. Where they fit into the
                                        box's own circle, they are drawn in smaller boxes, too */
static const double LABEL_DARK_FROM =
    0.22; /* luminance (of colours squared) from which dark text has more contrast than light */
static const double RED_LIGHT = 0.2126, GREEN_LIGHT = 0.7152, BLUE_LIGHT = 0.0722; /* of sRGB: ITU-R BT.709 */

/* Marks: in units of the shorter side of the panel, in pixels, and in units of the median box. */

static const double MARK_DOT = 0.0052, MARK_LINE = 0.0034;
static const double MIN_DOT = 2.2, MIN_LINE = 1.4;    /* smaller where boxes are so small that these would cover them */
static const double DOT_BOX = 0.13, LINE_BOX = 0.085; /* at most */
static const double FINEST = 0.6;                     /* pixels; the smallest dot and the thinnest line */
static const double MODE_SIDE = 1.1, MODE_BAR = 1.7, MODE_WRONG = 2.5; /* radius of a dot: half a square's side, ... */
static const double MODE_HALO = 1;                                     /* pixels */
static const double POINTER = 0.055, POINTER_LINE = 0.0075;            /* to a bomb outside: length, thickness */
static const double MIN_POINTER = 14, MIN_POINTER_LINE = 2;
static const double POINTER_INSET = 3; /* from the edge / its thickness: half its head */

static const double TRAIL_DURATION = 2;    /* s */
static const double MIN_TRAIL = 0.5;       /* m; a body that moved less in this time has no trail */
static const double OLDEST_OPACITY = 0.15; /* opacity of a trail's oldest end */
static const double TRAIL_TOLERANCE = 0.4; /* pixels; largest deviation of a segment from the trail */
static const int TRAIL_FRAMES_MAX = 600, TRAIL_EVERY = 2,
                 SEGMENT_FRAMES = 8; /* of a trail, between points, of a segment */

static const double MIN_SPEED = 0.05; /* m/s; slower bodies have no arrow, or every resting body would show one */
static const double MAX_ARROW = 0.28, MAX_ARROW_BOXES = 4;
static const double FASTEST_ARROW = 0.20, FASTEST_ARROW_BOXES = 3; /* the arrow of the first run's fastest body */
static const double COMMON_ARROW = 0.10, COMMON_ARROW_BOXES = 1.2; /* of the 90th percentile of impulses */
static const double LEGEND_ARROW = 0.07, LEGEND_ARROW_BOXES = 3.5; /* in the legend, at most */
static const double LEGEND_DOT = 0.18,
                    LEGEND_LINE = 0.11;   /* ems: samples are at least this large, or could not be made out */
static const double LEGEND_DECADE = 3;    /* ems, width of a decade on the colour scale */
static const int LEGEND_TRAIL_PARTS = 8;  /* shades of the sample of a trail */
static const double LEGEND_MIDDLE = 0.36; /* ems, of samples above the baseline */

/* Rows of text, in units of the picture's height, or of this share of its width if it is less. */

static const double UNIT_WIDTH = 0.75;
static const double SCENE_FONT = 0.0300, STATUS_FONT = 0.0225, TITLE_FONT = 0.0225, METHOD_FONT = 0.0205,
                    AXIS_FONT = 0.0170;
static const double PAGE_MARGIN = 0.030, MIN_MARGIN = 4; /* the second in pixels */
static const double HEADER_RISE = 0.026, HEADER_GAP = 0.006;
static const double TITLE_RISE = 0.016, TITLE_ROW = 0.058;
static const double CAPTION_PITCH = 0.030, CAPTION_PITCH_EMS = 1.2;
static const double AXIS_DROP = 0.0275, AXIS_ROW = 0.038, AXIS_TICK = 0.006;
static const double LEGEND_ROW = 0.046, LEGEND_PITCH = 0.035, LEGEND_DROP = 0.012;
static const double PAGE_FOOT = 0.016;

/* Distances, in captions and in curves over time. */

static const double DISTANCE_TWO_PLACES = 9.995, DISTANCE_ONE_PLACE = 99.95, DISTANCE_MOST = 999.5; /* m, below which */
static const int LOWEST_DECADE = -6, HIGHEST_DECADE = 3,
                 MIN_DECADES = 3; /* of curves: 1 um to 1 km at most, 1 mm at least */

/* Slow motion: s of simulated time before the bomb's impact and after it, enough to see it arrive and the boxes fly. */

static const double SLOW_BEFORE = 0.15, SLOW_AFTER = 0.6;

/* Panels and their metre grid. */

static const double GAIN = 1.05, GAIN_WITH_CUT_NAMES = 1.5; /* of scale: an unusual arrangement has at least this */
/* Of a panel's width and height: what the scene covers at least, or the panel shrinks until it covers the third
   share. */
static const double LEAST_SHARE_X = 0.2, LEAST_SHARE_Y = 0.4, FULL_SHARE = 0.65;
static const double LEAST_PANEL_WIDTH = 22, LEAST_PANEL_HEIGHT = 5; /* ems of the captions, of a panel that shrinks */
static const double WHOLE_SCALE = 12;  /* from here on a whole number of pixels a metre costs little room */
static const double LEAST_SCALE = 0.7; /* of the largest scale: for the sake of what happens after the impact */
static const double SCALE_PARTS = 64;  /* below, a whole number of these parts of a pixel, from one pixel a metre on */
static const double MIN_SPACING = 0.010;  /* between thin lines / the panel's height */
static const double MIN_PIXELS = 6;       /* the same, in pixels */
static const double MAX_SPACING = 0.6;    /* between strong lines / the panel's height */
static const double NUMBER_SPACING = 2.5; /* ems between two lines that both have a number */
static const int MIN_TICS = 3;
