/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG sequences: the files of a folder, each a stem and a number, such as frame_000123.png. Files of one stem are a
   sequence; a folder may hold several, and pictures without a number. A single file is a sequence of one. */
#pragma once
#include "common/error.h"
#include "image/image.h"

#include <stdint.h>

typedef struct SequenceFrame {
    char *path;
    const char *name; /* the end of path: the name in its folder, UTF-8 without control characters */
    int stem;         /* bytes of name before the number, or before ".png" */
    int64_t number;   /* -1: none */
} SequenceFrame;

typedef struct ImageSequence {
    char *folder; /* "." for that of a bare file name */
    bool single;  /* one file, not a folder */
    int count;
    SequenceFrame *frames; /* [count], by stem, then number */
} ImageSequence;

/* The PNG files of a folder, of which there may be none, or one file. ERROR_INPUT where path is neither, a number comes
   twice under one stem, or a name is no text. Hidden files do not count. */
ImageSequence *image_sequence_open(const char *path, Error *error);
void image_sequence_close(ImageSequence *sequence);

typedef struct SequencePair {
    const SequenceFrame *a, *b; /* one of them NULL where the other sequence lacks the frame */
} SequencePair;

/* Frames of the same stem and number side by side; two single files, and frames of the same number where each of the two
   folders has but one stem. malloc'ed; NULL with error set when memory is short or a file meets a folder. */
SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error);

/* True for UTF-8 without control characters. */
bool name_is_text(const char *name);
