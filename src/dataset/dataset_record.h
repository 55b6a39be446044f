/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a recording is made of: scenes and launches. Ranges of launches can be recorded one by one. */
#pragma once
#include "dataset/dataset.h"

typedef struct DatasetRecording {
    const DatasetOptions *options;
    Scene *scenes[DATASET_MAX_SCENES];
    Dataset *dataset; /* its launches, and no rows yet */
} DatasetRecording;

/* Checks the options, reads the scenes and makes the launches. Errors as dataset_record(). dataset_recording_end(), also after
   a failure. */
bool dataset_recording_begin(DatasetRecording *recording, const DatasetOptions *options, Error *error);
void dataset_recording_end(DatasetRecording *recording);

/* Records launches first .. end - 1 into the arrays of rows of *part, which must have none: a copy of recording->dataset, or
   that dataset itself. dataset_free_rows() frees them, also after a failure. */
bool dataset_record_launches(const DatasetRecording *recording, int first, int end, Dataset *part,
                             const Progress *progress, Error *error);

/* ERROR_INPUT if there are no rows. */
bool dataset_check_rows(int64_t rows, Error *error);

void dataset_free_rows(Dataset *dataset);
