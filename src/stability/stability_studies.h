/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is studied: along which numbers of which scenes methods are led to where they fail. */
#pragma once
#include "scene/scene.h"
#include "stability/border_search.h"

/* One number of a scene of scenes/stability, and where another of its numbers stands meanwhile. */
typedef struct StabilityStudy {
    const char *name;  /* of the study, in tables */
    const char *scene; /* file name without folder and ending */
    const char *parameter;
    BorderScan scan;
    SceneSetting fixed; /* name "": nothing but the parameter is set */
    bool stands;        /* VerdictRun */
    bool iterations;    /* the scene's iterations are scanned: only for methods that take them from there */
    bool unshifted;     /* a tiny shift tells nothing: it is rounded away, or nothing comes near anything else */
    bool rests;         /* a run's drift and energy count as well as its verdict */
    bool quick;         /* one of the few that are looked at in a quick run */
    double weight;      /* s for all methods on two cores, roughly */
} StabilityStudy;

/* Two numbers at once, on a grid. */
typedef struct StabilityAxis {
    const char *parameter;
    BorderScan scan; /* its points alone count */
    int quick_points;
} StabilityAxis;

typedef struct StabilityMap {
    const char *name, *scene;
    StabilityAxis x, y;
    bool stands, iterations, quick; /* as above */
    double weight;
} StabilityMap;

extern const StabilityStudy stability_studies[];
extern const StabilityMap stability_maps[];
extern const int stability_study_count, stability_map_count;

/* The study of that name, or NULL. */
const StabilityStudy *stability_study_find(const char *name);
