/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart_pages.csv: the launch that was worst for each point of a chart, and the page that plays it. */
#pragma once
#include "study/chart_csv.h"

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
