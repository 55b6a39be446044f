/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plot in a sketch: a linear axis below, a logarithmic one at the left. */
#pragma once
#include "sketch/log_axis.h"
#include "sketch/sketch.h"

typedef struct Plot {
    Point low, high;   /* corners of its frame on the page, mm */
    double begin, end; /* of the axis below */
    LogAxis axis;      /* its ends on the page are those of the frame */
    double points;     /* of type */
} Plot;

/* Room that tics, numbers and names of the axes need left of and below the frame, mm. */
double plot_left_margin(double points);
double plot_bottom_margin(double points);

/* For values of [least, most], both above 0, or more. */
void plot_begin(Plot *plot, Point low, Point high, double begin, double end, double least, double most, double points);

/* Where a value lies; within the frame. */
Point plot_place(const Plot *plot, double x, double y);

/* Guides, frame, tics, numbers and names. */
void plot_put_axes(const Plot *plot, Sketch *sketch, const char *x_name, const char *y_name);
