/* SPDX-License-Identifier: GPL-3.0-or-later */
/* system_subspace.csv: what a step of subspace costs and how far its runs end up, beside the engines that it replaces and
   beside what its components alone lose. Source: Holden et al. 2019 (subspace/subspace_net.h). */
#pragma once
#include "csv/csv_table.h"
#include "paper/systems/system_claims.h"

enum { SUBSPACE_STUDY_ROWS_MAX = 100 };

/* Distances are those of positions from the runs of the offline engine that recorded the training launches
   (SUBSPACE_OFFLINE), over all bodies, frames and held-out launches; NAN where a number is not applicable. */
typedef struct SubspaceStudyRow {
    int scene;                      /* of paper_scene_names */
    const char *method;             /* as on the command line */
    double components;              /* 0: an engine */
    double launches, frames;        /* how many; frames of each with the bomb */
    double us_step;                 /* microseconds: an engine's whole step; the method's whole own work */
    double rms, frames_near;        /* m; frames until a body is 0.1 m away, median */
    double floor_rms, floor_near;   /* the same of the recorded poses, projected and reconstructed */
    double linear_rms, linear_near; /* the same of the linear term alone */
} SubspaceStudyRow;

extern const CsvLayout subspace_study_layout;

/* The offline engine of the claims: the converged solution of each step. */
#define SUBSPACE_STUDY_OFFLINE "reference"

/* States the claims (PaperSystem.claim). */
bool subspace_claim(const Claims *claims, Error *error);

/* The row of a method in a scene of paper_scene_names, or NULL. */
const SubspaceStudyRow *subspace_study_find(const SubspaceStudyRow *rows, int count, int scene, const char *method);
