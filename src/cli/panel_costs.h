/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The time per step of each panel's method, for the captions. */
#pragma once
#include "cli/panels.h"

typedef struct PanelCosts {
    char texts[RENDER_PANELS_MAX][64];
} PanelCosts;

/* Reads the costs of the panels from a chart.csv: the same scene, closed loop, at the impact. A run without a row has no
   cost; a file without any row for the runs is refused. The look then points into `costs`. */
bool panel_costs_read(PanelCosts *costs, const char *path, const Panels *panels, RenderLook *look, Error *error);
