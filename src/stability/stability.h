/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where each method fails: borders between holding and failing along a number (stability.csv), maps of two numbers
   (maps.csv), why a method does not go with a scene (refusals.csv), what networks said and was not done
   (fallbacks.csv), and how far what is left alone drifts (rest.csv). */
#pragma once
#include "common/error.h"
#include "common/progress.h"

#include <stdbool.h>

enum { STABILITY_MAX_NAMES = 64 };

typedef struct StabilityOptions {
    const char *folder;  /* where the tables go; made where it is missing */
    const char *scenes;  /* the folder above stability/ */
    const char *methods; /* contenders_parse; NULL: those of the study */
    bool quick;          /* few studies, small maps */
    int name_count;      /* of studies and maps to do; 0: all */
    const char *names[STABILITY_MAX_NAMES];
} StabilityOptions;

/* Runs the study and writes the tables. What is cut off goes on with the study or map that was in hand. The tables are the
   same whatever the number of threads. ERROR_INPUT also for a name that there is not, and where progress asks to stop. */
bool stability_run(const StabilityOptions *options, const Progress *progress, Error *error);
