/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG sequences and their pairs:

     ImageSequence *a = image_sequence_open("expected", true, false, error), *b = ...;
     SequencePair *pairs = image_sequence_pair(a, b, &count, error);

   A sequence has the files of a folder whose names consist of a stem and a number, such as frame_000123.png. A folder
   may hold several sequences (stems), pictures without number, and subfolders with pictures. A single file is a
   sequence of one. */
#pragma once
#include "base/base.h"

#include <stdint.h>

typedef struct SequenceFrame {
    char *path;
    const char
        *name;  /* relative to the compared folder ("sub/x.png"), the end of `path`: UTF-8 without control characters */
    int folder; /* length of the name's folder with its slash, 0 if it has none */
    int stem;   /* length of the name up to the number in bytes, with the folder */
    int64_t number;             /* -1: none */
    struct SequenceFrame *next; /* another accepted picture for the same name, set by image_sequence_pair(); or NULL */
} SequenceFrame;

typedef struct ImageSequence {
    uint64_t device, inode; /* of the file or folder */
    char *folder;           /* "." for a bare file name */
    bool single;            /* one file, not a folder */
    int count;
    SequenceFrame *frames; /* [count], sorted by folder, stem, number, name */
    int skipped;           /* pictures in subfolders that were not to be read */
    int others;            /* pictures of other kinds, which are no frames */
    char other_names[100]; /* "x.webp, y.jpg", of the first */
} ImageSequence;

/* The PNG files of a folder (possibly none) and, if recursive, of its subfolders; or one file. Files are found as
   folder_list() finds them. all_kinds: pictures of other kinds are frames, too, which nobody can read. ERROR_INPUT if
   there is no such path, or if a name is not text. */
ImageSequence *image_sequence_open(const char *path, bool recursive, bool all_kinds, Error *error);
void image_sequence_close(ImageSequence *sequence);

typedef struct SequencePair {
    const SequenceFrame *a, *b; /* NULL if the other sequence lacks the frame */
} SequencePair;

/* Pairs the frames of each folder: those of equal names first, then those of equal stem and number. If both folders
   have one stem and only numbered frames, numbers alone decide. Two single files are a pair.

   home.1.png, home.2.png ... in `a` are further accepted pictures for home.png if both sequences have home.png and `b`
   has no home.N.png: they make no pair, but follow home.png by `next`.

   malloc'ed, sorted by folder, stem and number. NULL with error set if out of memory, for a file and a folder, or if
   several frames of equal number could make a pair. */
SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error);

/* Whether both are numbered frames of one sequence. */
bool sequence_same(const SequenceFrame *x, const SequenceFrame *y);

/* Whether a name is UTF-8 without characters that a terminal obeys (control_in_text()). */
bool name_is_text(const char *name);
