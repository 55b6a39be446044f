/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by figures of runs: the frames, the part of the world, and its rendered pixels. */
#pragma once
#include "figure/figure.h"
#include "picture/caption_size.h"
#include "render/still.h"

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

/* Widens the window on both sides, or raises its top, to this aspect ratio. */
void run_window_fill(WorldWindow *window, double shape);

/* Whether a body is there with its centre outside the window; and the number of such dynamic bodies. */
bool run_is_outside(const Trajectory *run, int frame, int body, const WorldWindow *window);
int run_count_outside(const Trajectory *run, int frame, const WorldWindow *window);

/* Cells of equal size on the page that show a window of the world, and their renderer. */
typedef struct RunCells {
    WorldWindow window;
    double width, height; /* mm, a whole number of pixels */
    double scale;         /* mm per metre */
    Camera camera;
    int columns, rows; /* pixels */
    Still *still;
} RunCells;

/* Chooses the largest size that fits into width x height mm. Free the cells also after a failure. */
bool run_cells_begin(RunCells *cells, const WorldWindow *window, double width, double height, double dpi, Error *error);
void run_cells_free(RunCells *cells);

/* Renders part of a frame into a new image of a cell's size. */
Image *run_cells_render(RunCells *cells, const Trajectory *run, int frame, MethodColour colour, StillParts parts,
                        Error *error);

/* Renders a frame onto the page, lower left corner at `low`. */
bool run_cells_draw(RunCells *cells, Sketch *sketch, Point low, const Trajectory *run, int frame, MethodColour colour,
                    Error *error);

/* The mapping from metres to the page in a cell. */
View run_cells_view(const RunCells *cells, Point low);

/* Draws a scale bar below the cells: a round length of at most a quarter of a cell, from `left`. */
void run_cells_draw_scale_bar(const RunCells *cells, Sketch *sketch, Point left, double points);

/* Line height of text, mm. */
double line_height(double points);

/* The caption of one of the figure's runs, or the name of its method (common/method_look.h). */
typedef struct RunName {
    char text[CAPTION_SIZE];
} RunName;
RunName run_name(const FigureSpec *spec, const Trajectory *run);

/* The runs' colours, FIGURE_RUNS_MAX of them. */
void run_colours(const FigureSpec *spec, MethodColour *colours);
