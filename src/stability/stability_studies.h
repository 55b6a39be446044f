/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of stability studies: which scene, which parameter, which range. */
#pragma once
#include "scene/scene.h"
#include "stability/border_search.h"

/* A scan of one parameter of a scene of scenes/stability. */
typedef struct StabilityStudy {
    const char *name;  /* of the study, in tables */
    const char *scene; /* file name without folder and extension */
    const char *parameter;
    BorderScan scan;
    SceneSetting fixed; /* another parameter that is set; name "": none */
    bool stands;        /* as in VerdictRun */
    bool iterations;    /* scans the scene's iterations: only for methods that use them */
    bool unshifted;     /* without seeds: a tiny shift has no effect, as it is rounded away or nothing comes near */
    bool rests;         /* also records drift and energy of every run */
    bool quick;         /* part of a quick run */
    double weight;      /* s for all methods on two cores, approximately */
    const char *file;   /* path of another scene instead; `stands` then follows from each scene (verdict_run_of) */
} StabilityStudy;

typedef struct StabilityAxis {
    const char *parameter;
    BorderScan scan; /* only its coarse scan is used */
    int quick_points;
} StabilityAxis;

/* A grid over two parameters. */
typedef struct StabilityMap {
    const char *name, *scene;
    StabilityAxis x, y;
    bool stands, iterations, quick; /* as above */
    double weight;
    const char *file; /* as above */
} StabilityMap;

extern const StabilityStudy stability_studies[];
extern const StabilityMap stability_maps[];
extern const int stability_study_count, stability_map_count;

/* The study of this name, or NULL. */
const StabilityStudy *stability_study_find(const char *name);
