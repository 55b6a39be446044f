/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pages of charts: the launch that was worst for each point, chart_pages.csv and chart.html. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/chart_plot.h"
#include "studies/scene_study.h"

#include <stdbool.h>

/* The launch that was worst for a method in a chart: what a page shows of a point. */

typedef struct WorstLaunch {
    int launch;        /* of the study's; -1: no step of the phase was scored */
    double mean;       /* m/s: its mean error in the phase, chart.csv's error_worst */
    double error;      /* m/s: of the scored step of the phase with the largest error, */
    int frame, body;   /* which leads to this frame; its body with the largest error, or -1 */
    int touch, frames; /* the first step in which the bomb touches; frames of the run: fewer if its state became NaN */
} WorstLaunch;

/* Runs all launches of the study in closed loop once more, in parallel, and fills the impact and after phases of
   worst[PHASES]. */
bool worst_launch_find(const SceneStudy *study, const Method *method, WorstLaunch worst[PHASES],
                       const Progress *progress, Error *error);

/* chart_pages.csv: the launch that was worst for each point of a chart, and the page that plays it. */

/* m, rad, rad/s, kg, s, m/s; frames from 0. */
typedef struct LaunchPage {
    const char *scene, *method, *setting; /* of the point, as in chart.csv */
    Phase phase;
    int launch; /* of the study's, from 1 */
    float x, rotation, spin, mass;
    int launch_frame;
    double error_worst; /* mean over the phase, as in chart.csv */
    double error;       /* of the worst step, which leads to: */
    double time;
    int frame, body;  /* body -1: none */
    const char *page; /* "pages/NAME.html#t=0.55&body=7&run=1"; empty: left out */
    int bytes;        /* of the page */
} LaunchPage;

extern const CsvLayout launch_page_layout;

/* Writes folder/chart.html from chart.csv, chart_pages.csv and the charts' .svg files there. Without a
   script: a picture with links above its points, which a table repeats for the keyboard. look: as of the charts. */
bool chart_html_write(const char *folder, const ChartLook *look, Error *error);
