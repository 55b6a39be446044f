/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of sain: networks trained on launches of the stack alone, scored on impacts of held-out launches of the
   stack and of the settled pyramid. */
#pragma once
#include "paper/systems/system.h"

#include "relation/relation_network.h"

typedef enum SainScene { SAIN_STACK, SAIN_PYRAMID, SAIN_SCENES } SainScene;

extern const char *const sain_scene_words[SAIN_SCENES + 1]; /* scene files without .yaml */

/* A training, scored on one scene. RMS velocity errors of all bodies that touch another, m/s. */
typedef struct SainRow {
    int scene, form; /* SainScene, RelationForm */
    int launches;    /* of the stack, trained on */
    int seed;
    double error, engine, constant; /* the network; 10 sweeps alone; the mean correction of the training data */
} SainRow;

extern const CsvLayout sain_layout; /* system_sain.csv */

enum { SAIN_MAX_LAUNCHES = 64, SAIN_LITTLE = 16 /* launches: "little data" */ };

/* The median over seeds; NaN without rows. of: the row's number. */
typedef double SainNumber(const SainRow *row);
double sain_median(const CsvTable *table, SainScene scene, RelationForm form, int launches, SainNumber *of);

SainNumber sain_error, sain_engine_error, sain_constant_error;

/* The most launches of any row. */
int sain_most_launches(const CsvTable *table);

bool sain_claims_state(const Claims *claims, Error *error);
