/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axes of a map: one place for each value, whatever the distance of the values. */
#pragma once
#include "sketch/plot.h"

/* mm: width of the longest number of the values. */
double map_axis_width(const double *values, int count);

/* An axis with a place for each value, in the order of the values, 0 to count - 1. room: mm that a value has. Numbers are
   thinned so that they do not touch, to values that are as round as possible. The ticks must outlive the axis. */
PlotAxis map_axis(PlotTicks *ticks, bool across, const double *values, int count, double room);
