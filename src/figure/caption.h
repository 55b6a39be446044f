/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The caption of a figure for LaTeX: \caption{...} with scene, methods, times and version. */
#pragma once
#include "figure/figure.h"

#include <stdio.h>

/* What kinds write in their captions. A run's method, what that is, and the sweeps that the scene sets:
   "\texttt{engine} (sequential impulses, \texttt{k=10})", behind the run's caption if it has one. */
void caption_run(FILE *out, const FigureSpec *spec, const Trajectory *run);

/* All runs of the spec from `first` on. */
void caption_runs(FILE *out, const FigureSpec *spec, int first);

/* "scene \texttt{stack}" */
void caption_scene(FILE *out, const FigureSpec *spec);

/* " at 0.5, 0.6 and 0.8~s"; many moments by their number, the first and the last. */
void caption_times(FILE *out, const FigureSpec *spec);
