/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures of stored runs for papers: scenes as pixels, everything else as vector graphics and text.

     FigureSpec spec = {.width = FIGURE_PAGE_WIDTH, .points = FIGURE_POINTS, .dpi = SKETCH_DPI, .run_count = 1};
     spec.runs[0] = run, spec.paths[0] = "engine.npz";
     figure_draw(figure_kind("strip", &error), &sketch, &spec, &error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "runs/trajectory.h"

enum { FIGURE_RUNS_MAX = RENDER_PANELS_MAX, FIGURE_MOMENTS_MAX = 60, FIGURE_BODIES_MAX = 64 };

#define FIGURE_WIDTH_MIN 40.0
#define FIGURE_WIDTH_MAX 400.0
#define FIGURE_HEIGHT_MIN 20.0
#define FIGURE_HEIGHT_MAX 240.0 /* mm; higher figures are scaled down or refused */
#define FIGURE_POINTS 8.0       /* font size */
#define FIGURE_POINTS_MIN 5.0
#define FIGURE_POINTS_MAX 14.0

/* What to draw. Zero it, then fill it in; all pointers belong to the caller. */
typedef struct FigureSpec {
    double width, points, dpi; /* mm; font size; resolution of pictures */
    double height;             /* mm; 0: the kind chooses */
    int run_count;
    const Trajectory *runs[FIGURE_RUNS_MAX];
    const char *paths[FIGURE_RUNS_MAX];    /* file names of the runs, for messages */
    const char *captions[FIGURE_RUNS_MAX]; /* instead of the names of the runs' methods; NULL or "": these */
    ColourChoices colours;
    int time_count;                   /* 0: the kind chooses */
    double times[FIGURE_MOMENTS_MAX]; /* s, ascending */
    int moments;                      /* number of equidistant moments; 0: the kind chooses */
    const char *scene;                /* divergence: scene of the first run, for the band of chaotic divergence;
                                           NULL: no band */
    CameraView view;                  /* the part of the world to show; width 0: that of `view_from` */
    const Trajectory *view_from;      /* the run whose bodies set the view; NULL: the first */
    int body_count;                   /* 0: the kind chooses */
    int bodies[FIGURE_BODIES_MAX];    /* strip: those that must be in view */
    LookLabels labels;                /* strip: in boxes that are large enough */
    unsigned show;                    /* strip: SHOW_MODES or nothing */
    const Progress *progress;         /* of simulations run for the figure, or NULL */
} FigureSpec;

typedef struct FigureKind {
    const char *name, *summary;
    const char *example; /* arguments after `twinbox figure` */
    int min_runs, max_runs;
    bool takes_times, takes_moments, takes_scene, takes_height, takes_view, takes_bodies, takes_labels, takes_show;
    bool needs_contacts; /* runs without are refused; trajectory_find_contacts() finds them again */
    /* Begins the sketch and draws. ERROR_INPUT for what cannot be shown; the caller frees the sketch, also on
       failure. */
    bool (*draw)(Sketch *sketch, const FigureSpec *spec, Error *error);
} FigureKind;

/* All kinds; ends with NULL. */
const FigureKind *const *figure_kinds(void);

/* Draws a kind with the title of its files: "strip of stack: engine, momentum:k=20". As FigureKind.draw. */
bool figure_draw(const FigureKind *kind, Sketch *sketch, const FigureSpec *spec, Error *error);

/* NULL with error set, which lists the kinds, if there is no such kind. */
const FigureKind *figure_kind(const char *name, Error *error);
