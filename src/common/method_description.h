/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lists, charts, studies and captions know of a method. A field left zero has a sensible default: a name and a
   summary are enough to begin with. */
#pragma once
#include "common/settings.h"

#include <stdbool.h>

/* What a method's results are compared for. */
typedef enum MethodRole {
    METHOD_COMPETES, /* for speed and accuracy */
    METHOD_BASELINE, /* solves nothing; other methods must be more accurate */
    METHOD_REFERENCE /* the converged solution: errors of other methods are measured against it */
} MethodRole;

/* Settings that a study runs a method with, each as on the command line ("k=10,warm=off"; "": none given), ended by
   NULL. */
typedef const char *const *MethodRuns;

#define METHOD_RUNS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define METHOD_NO_RUNS ((const char *const[]){NULL})

typedef struct MethodDescription {
    const char *name, *summary;  /* as on the command line; one line for `twinbox methods` */
    const SettingSpec *settings; /* ended by a NULL key; NULL: the method has none */
    const char *title;           /* in pictures: "Physics engine"; NULL: the method's text ("nncg:k=20") */
    const char *caption;         /* in pictures, between the title and the method's text; NULL: nothing */
    MethodRole role;
    bool no_push_out;   /* it moves overlapping bodies apart without giving them a velocity; so the converged velocities
                            that it is scored against have none of position correction either */
    bool falls_back;    /* sweeps may solve a step instead; results report how often, as for networks */
    bool needs_network; /* runs only if the setting `network` or the scene names a file */
    const char *twin;   /* of a learned method: its ablation, as on the command line ("momentum"); it takes the same
                            settings otherwise. NULL: nothing is learned */
    const char *shipped; /* the setting in common use, which charts mark; NULL: none */
    /* What `twinbox chart`, `twinbox chart --quick` and `twinbox stability` run by default. NULL: one run, no settings
       given. METHOD_NO_RUNS: left out unless named, and reported as left out. */
    MethodRuns chart, chart_quick, stability;
    int stability_place; /* 1, 2, ...: place in the stability study; 0: behind those that have one, in registry order */
} MethodDescription;
