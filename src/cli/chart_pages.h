/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of a chart: each plays the launch that was worst for a point beside the converged run. */
#pragma once
#include "study/speed_accuracy.h"

/* Runs again what the chart has measured, and writes folder/pages/SCENE-METHOD-N-launch-L.html, folder/chart_pages.csv
   (study/launch_page.h) and folder/chart.html, whose points and table link to the pages. A page begins a quarter of a second
   before the bomb touches and ends as long after the last scored step. Prints how many pages there are, and what was left
   out. */
bool chart_pages_write(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key,
                       Error *error);
