/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures of stored runs, as papers print them: the scene as pixels, all else as lines and words. */
#pragma once
#include "common/progress.h"
#include "render/render.h"
#include "sketch/page_width.h"
#include "sketch/sketch_files.h"
#include "trajectory/trajectory.h"

enum { FIGURE_RUNS_MAX = RENDER_PANELS_MAX, FIGURE_MOMENTS_MAX = 60 };

#define FIGURE_LEAST_WIDTH 40.0
#define FIGURE_LARGEST_WIDTH 400.0
#define FIGURE_TALLEST 240.0 /* mm; what would be higher is made smaller or refused */
#define FIGURE_POINTS 8.0    /* of type */
#define FIGURE_LEAST_POINTS 5.0
#define FIGURE_LARGEST_POINTS 14.0

/* What is to be drawn. Zero it, then fill in; all is the caller's. */
typedef struct FigureSpec {
    double width, points, dpi; /* mm, of type, of the pixels of scenes */
    int run_count;
    const Trajectory *runs[FIGURE_RUNS_MAX];
    const char *paths[FIGURE_RUNS_MAX]; /* that they came from, for errors */
    int time_count;                     /* 0: the kind chooses */
    double times[FIGURE_MOMENTS_MAX];   /* s, rising */
    int moments;                        /* so many, as far from each other; 0: the kind chooses */
    const char *scene;                  /* divergence: of the first run, for the band of chaos; NULL: without it */
    const char *network;                /* network: its file */
    int bodies[2];                      /* narrow-phase: the pair; equal: the kind chooses */
    const Progress *progress;           /* of runs that are made anew, or NULL */
} FigureSpec;

typedef struct FigureKind {
    const char *name, *summary;
    const char *example;       /* what follows `twinbox figure` */
    int least_runs, most_runs; /* 0, 0: a network's file instead */
    bool takes_times, takes_moments, takes_scene, takes_bodies;
    /* Draws into a sketch that it begins; on failure (ERROR_INPUT for what cannot be shown) it is to be freed, too. */
    bool (*draw)(Sketch *sketch, const FigureSpec *spec, Error *error);
} FigureKind;

/* All kinds, ended by NULL. */
const FigureKind *const *figure_kinds(void);

/* NULL with error set, which lists them, where there is no such kind. */
const FigureKind *figure_kind(const char *name, Error *error);
