/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What figures of runs share: which frames, which part of the world, and the renderer's pixels of it. */
#pragma once
#include "figure/run_figures.h"
#include "render/still.h"

/* The frames that the figure's times name, or `moments` ones from the first to the last; into frames[FIGURE_MOMENTS_MAX].
   Refuses what a run does not reach. `after`: frames that must follow the last. */
bool run_frames(const FigureSpec *spec, int moments, int after, int *frames, int *count, Error *error);

/* Refuses runs of different worlds or steps. */
bool run_check_worlds(const FigureSpec *spec, Error *error);

/* A part of the world, m. */
typedef struct WorldWindow {
    double left, bottom, width, height;
} WorldWindow;

/* What the scene asks to see, or all that moves in these frames of the run, with a margin. */
WorldWindow run_window(const Trajectory *run, const int *frames, int count);

/* Adds as much on either side as a shape (width over height) needs that is wider. */
void run_window_widen(WorldWindow *window, double shape);

/* How many bodies that move are there with their centre outside. */
int run_count_outside(const Trajectory *run, int frame, const WorldWindow *window);

/* Cells of one size on the page that show a window of the world: their size in mm, and the renderer for them. */
typedef struct RunCells {
    WorldWindow window;
    double width, height; /* mm, whole pixels */
    double scale;         /* mm a metre */
    Camera camera;
    int columns, rows; /* pixels */
    Still *still;
} RunCells;

/* As large as fits into width x height mm. To be freed, also after a failure. */
bool run_cells_begin(RunCells *cells, const WorldWindow *window, double width, double height, double dpi, Error *error);
void run_cells_free(RunCells *cells);

/* Draws part of a frame into a new image of a cell's size. */
Image *run_cells_shoot(RunCells *cells, const Trajectory *run, int frame, int colours, StillParts parts, Error *error);

/* The same, onto the page with its lower left corner at `low`. */
bool run_cells_put(RunCells *cells, Sketch *sketch, Point low, const Trajectory *run, int frame, int colours,
                   Error *error);

/* From metres to the page, in a cell. */
View run_cells_view(const RunCells *cells, Point low);

/* A bar to measure by below the cells, of a round length of at most a quarter of a cell; its left end. */
void run_cells_bar(const RunCells *cells, Sketch *sketch, Point left, double points);

/* Height of a line of words, mm. */
double line_height(double points);

/* Cuts words to a width in mm, the last character of what is left an ellipsis. */
void words_fit(char *words, double points, double width);
