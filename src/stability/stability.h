/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability study: where each method fails. Tables: borders between holding and failing along one parameter
   (stability.csv), maps over two parameters (maps.csv), methods that do not apply to a scene (refusals.csv), network
   outputs that were rejected and steps that fell back (fallbacks.csv), drift of undisturbed bodies (rest.csv). */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "pieces/pieces_estimate.h"
#include "stability/stability_own.h"

#include <stdbool.h>
#include <stdint.h>

enum { STABILITY_MAX_NAMES = 64 };

typedef struct StabilityOptions {
    const char *folder;  /* of the tables; created if missing */
    const char *scenes;  /* the folder that contains stability/ */
    const char *methods; /* contenders_parse; NULL: those of the study */
    bool quick;          /* few studies, small maps */
    int name_count;      /* of studies and maps to run; 0: all */
    const char *names[STABILITY_MAX_NAMES];
    const StabilityOwn *own; /* the studies of a scene file instead of the table's; NULL: the table's */
    const PiecesRun *run;    /* whole, a shard, or a merge */
    /* Draws the tables in the folder; NULL: nothing is drawn. The key is of what determines the tables (study_key.h). */
    bool (*draw)(void *context, uint64_t key, Error *error);
    void *draw_context;
} StabilityOptions;

/* Runs the studies and maps, writes the tables and draws; a shard does its pieces only. An interrupted run is resumed at
   the unfinished pieces. The tables do not depend on the number of threads. ERROR_INPUT also for an unknown name,
   ERROR_INTERRUPTED if progress stops the run. *pieces tells what was done; it has no plan any more. */
bool stability_run(const StabilityOptions *options, Pieces *pieces, const Progress *progress, Error *error);

/* What the run takes, from some of its pieces; nothing is written. */
bool stability_estimate(const StabilityOptions *options, PiecesEstimate *estimate, const Progress *progress,
                        Error *error);
