/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG sequences: files of a folder whose names consist of a stem and a number, such as frame_000123.png. A folder
   may hold several sequences (stems) and pictures without number. A single file is a sequence of one. */
#pragma once
#include "common/error.h"
#include "image/image.h"

#include <stdint.h>

typedef struct SequenceFrame {
    char *path;
    const char *name; /* the end of `path`: UTF-8 without control characters */
    int stem;         /* length of the stem in bytes */
    int64_t number;   /* -1: none */
} SequenceFrame;

typedef struct ImageSequence {
    char *folder; /* "." for a bare file name */
    bool single;  /* one file, not a folder */
    int count;
    SequenceFrame *frames; /* [count], sorted by stem, then number */
} ImageSequence;

/* The PNG files of a folder (possibly none), or one file. Hidden files are ignored. ERROR_INPUT if the path is
   neither, if a number occurs twice with one stem, or if a name is not text. */
ImageSequence *image_sequence_open(const char *path, Error *error);
void image_sequence_close(ImageSequence *sequence);

typedef struct SequencePair {
    const SequenceFrame *a, *b; /* NULL if the other sequence lacks the frame */
} SequencePair;

/* Pairs frames of equal stem and number; only of equal number if each folder has one stem; two single files.
   malloc'ed; NULL with error set if out of memory, or for a file and a folder. */
SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error);

/* Whether a name is UTF-8 without control characters. */
bool name_is_text(const char *name);
