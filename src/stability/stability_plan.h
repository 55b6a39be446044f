/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability study in pieces (pieces/pieces.h): some methods of a study along one parameter, or some cells of a map. */
#pragma once
#include "stability/stability_grid.h"
#include "stability/stability_scan.h"
#include "study/piece_tables.h"

/* A study or a map, and its pieces. */
typedef struct StabilityGroup {
    StabilityScan scan; /* study NULL: a map */
    StabilityGrid grid;
    const char *name;
    int items;     /* methods or cells */
    double weight; /* of each piece */
    bool begun;
    ScanContext scanned;
    GridContext mapped;
} StabilityGroup;

/* stability_plan_free(). groups and pieces have the same number. */
typedef struct StabilityPlan {
    StabilityGroup *groups;
    PieceGroup *pieces;
    int count;
    PiecePlan plan;
} StabilityPlan;

/* The studies and maps that are to be done, in their order. All pointers must outlive the plan. */
bool stability_plan_make(StabilityPlan *plan, const StabilityStudy *const *studies, int study_count,
                         const StabilityMap *const *maps, int map_count, const char *scenes,
                         const ContenderList *methods, bool quick, Error *error);
void stability_plan_free(StabilityPlan *plan);
