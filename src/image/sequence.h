/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG sequences: the files of a folder whose names end in a number, such as frame_000123.png. A single PNG
   file is a sequence of one. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "image/image.h"

#include <stdint.h>

typedef struct SequenceFrame {
    int64_t number;
    char *path;
} SequenceFrame;

typedef struct ImageSequence {
    int count;
    SequenceFrame *frames; /* [count], numbers rising */
} ImageSequence;

/* ERROR_INPUT where path is neither a folder with such files nor a file, or a number comes twice. */
ImageSequence *image_sequence_open(const char *path, Error *error);
void image_sequence_close(ImageSequence *sequence);

typedef struct SequenceDifference {
    int compared;                       /* frames that both have */
    int different;                      /* of those, not equal pixel by pixel */
    int only_a, only_b;                 /* frames that the other lacks */
    int64_t first_only_a, first_only_b; /* their first numbers */
    int64_t first;                      /* number of the first frame that differs, or -1 */
    ImageDifference at_first;
    int width_a, height_a, width_b, height_b; /* of the first frame that differs */
} SequenceDifference;

/* Compares decoded pixels, frame number by frame number. False with error set where a file cannot be read or
   progress asks to stop. */
bool image_sequence_compare(const ImageSequence *a, const ImageSequence *b, SequenceDifference *difference,
                            const Progress *progress, Error *error);
