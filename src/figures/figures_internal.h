/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the kinds of figures share: moments of runs, frames rendered into cells, texts.

     WorldWindow window = run_window(spec, frames, count);
     run_cells_begin(&cells, &window, width, height, spec->dpi, error);
     Image *image = run_cells_render(&cells, run, frames[0], &colours, STILL_ALL, error);
     run_cells_free(&cells); */
#pragma once
#include "base/base.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/trajectory.h"

#include <stdbool.h>
#include <stdio.h>

/* The kinds of figures. */
extern const FigureKind figure_strip, figure_annotated, figure_divergence, figure_strobe;

/* The frames of the spec's times, or of `moments` equidistant times over the whole run, in
   frames[FIGURE_MOMENTS_MAX]. ERROR_INPUT for times outside a run. `after`: number of frames that must follow. */
bool run_frames(const FigureSpec *spec, int moments, int after, int *frames, int *count, Error *error);

/* ERROR_INPUT for runs with different worlds or time steps. */
bool run_check_worlds(const FigureSpec *spec, Error *error);

/* A part of the world, m. */
typedef struct WorldWindow {
    double left, bottom, width, height;
} WorldWindow;

/* The spec's view. Without one, that of the run that the spec takes it from, or of the first: the view that its scene
   sets, or framing_in_frames() with a margin. */
WorldWindow run_window(const FigureSpec *spec, const int *frames, int count);

/* Widens the window on both sides to this aspect ratio (width / height), if it is narrower. */
void run_window_widen(WorldWindow *window, double shape);

/* How many dynamic bodies are there with their centre outside the window: of these, or of all if count is 0. */
int run_count_outside(const Trajectory *run, int frame, const WorldWindow *window, const int *bodies, int count);

/* Cells of equal size on the page that show a window of the world, and their renderer. */
typedef struct RunCells {
    WorldWindow window;
    double width, height; /* mm, a whole number of pixels */
    double scale;         /* mm per metre */
    Camera camera;
    int columns, rows; /* pixels */
    Still *still;
    LookLabels labels;  /* in boxes; none, unless set */
    double label_least; /* pixels */
} RunCells;

/* Chooses the largest size that fits into width x height mm. Free the cells also after a failure. */
bool run_cells_begin(RunCells *cells, const WorldWindow *window, double width, double height, double dpi, Error *error);
void run_cells_free(RunCells *cells);

/* Renders part of a frame into a new image of a cell's size. */
Image *run_cells_render(RunCells *cells, const Trajectory *run, int frame, const RunColours *colours, StillParts parts,
                        Error *error);

/* Writes what the boxes of such a picture are labelled with, into a cell. */
void run_cells_label(const RunCells *cells, Sketch *sketch, const Trajectory *run, int frame, const RunColours *colours,
                     Point low);

/* The mapping from metres to the page in a cell. */
View run_cells_view(const RunCells *cells, Point low);

/* A line around a cell. */
void run_cells_frame(const RunCells *cells, Sketch *sketch, Point low);

#define PAGE_EDGE 0.2   /* mm: margin of the page, half a frame's line */
#define SMALL_TYPE 0.85 /* size of small texts / the figure's font size */

/* The caption of one of the figure's runs, or the name of its method among theirs (methods/methods.h). */
typedef struct RunName {
    char text[CAPTION_TEXT_SIZE];
} RunName;
RunName run_name(const FigureSpec *spec, const Trajectory *run);

/* The runs' colours, FIGURE_RUNS_MAX of them. */
bool run_colours(const FigureSpec *spec, RunColours *colours, Error *error);

/* A text in lines of a width. */
typedef struct WrappedText {
    char text[2 * CAPTION_TEXT_SIZE + 192];
    int lines;
    double points;
} WrappedText;
WrappedText wrap_text(double points, double width, const char *format, ...) PRINTF_LIKE(3, 4);

/* From `left`, the middle of the first line. */
void draw_wrapped(Sketch *sketch, Point left, uint32_t ink, const WrappedText *text);
double wrapped_width(const WrappedText *text); /* mm: of the longest line */

/* Items below a picture, from left to right; the next row begins where one has no room. */
typedef struct Flow {
    Point first;   /* middle of the left end of the first row */
    double width;  /* mm */
    double points; /* font size, which sets the distance of rows and items */
    double used;   /* mm: of the row */
    int row;       /* from 0 */
} Flow;

/* The place of an item of so many lines, the last of which ends its row if there are several. */
Point flow_place(Flow *flow, double width, int lines);
void flow_text(Flow *flow, Sketch *sketch, uint32_t ink, const WrappedText *text); /* sketch NULL: takes its place */

/* The scale of cells as the next item, a bar of a round length of at most a quarter of a cell; without a sketch, it
   only takes its place. */
void run_cells_scale_bar(const RunCells *cells, Sketch *sketch, Flow *flow);
