/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plot in a sketch: linear x axis, logarithmic y axis. */
#pragma once
#include "sketch/log_axis.h"
#include "sketch/sketch.h"

typedef struct Plot {
    Point low, high;   /* corners of the frame on the page, mm */
    double begin, end; /* range of the x axis */
    LogAxis axis;      /* from low.y to high.y on the page */
    double points;     /* font size */
} Plot;

/* Space for tics, numbers and axis names left of and below the frame, mm. */
double plot_left_margin(double points);
double plot_bottom_margin(double points);

/* The y axis covers at least [least, most], both above 0. */
void plot_begin(Plot *plot, Point low, Point high, double begin, double end, double least, double most, double points);

/* The position of a value, clamped to the frame. */
Point plot_place(const Plot *plot, double x, double y);

/* Draws guides, frame, tics, numbers and axis names. */
void plot_draw_axes(const Plot *plot, Sketch *sketch, const char *x_name, const char *y_name);
