/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's data (Avatavului, Ifrim, Voncila 2023, section 3.1): for every touching pair of bodies and every
   step, what the solver saw and what it did to that pair. */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "common/progress.h"
#include "dynamics/pair.h"

#include <stddef.h>
#include <stdint.h>

enum { DATASET_VERSION = 1, DATASET_MAX_SCENES = 16, DATASET_NAME_SIZE = 128 };

typedef struct Dataset {
    int64_t rows;
    float *inputs;   /* [rows, PAIR_INPUTS]: pair_inputs() */
    float *changes;  /* [rows, PAIR_CHANGES]: pair_changes() */
    int32_t *launch; /* [rows] which launch the row comes from */
    int32_t *frame;  /* [rows] number of the step */
    int32_t *bodies; /* [rows, 2] */
    int launches;
    int32_t *launch_scene; /* [launches] index into scenes */
    float *launch_x;       /* [launches] bomb x, m */
    uint8_t *launch_test;  /* [launches] 1: held out for the test score (80/20, drawn with the seed) */
    int scene_count;
    char scenes[DATASET_MAX_SCENES][DATASET_NAME_SIZE];
} Dataset;

typedef struct DatasetOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    FloatRange bomb_x; /* m, of the launches; at least 5 of them, so that one can be held out */
    uint64_t seed;     /* of the 80/20 split by launch */
} DatasetOptions;

/* Runs every launch of every scene by the engine and records it. The result does not depend on the number of
   threads. ERROR_INPUT where a scene cannot be read or has no bomb, or progress asks to stop. */
Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error);
void dataset_destroy(Dataset *dataset);

bool dataset_write(const Dataset *dataset, const char *path, Error *error);
Dataset *dataset_read(const char *path, Error *error);
