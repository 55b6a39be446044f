/* SPDX-License-Identifier: GPL-3.0-or-later */
/* manifest.json beside the pictures of a sequence: what was drawn (version, runs, look, order) and, a line for each file,
   the frame it shows, the state hashes of the runs there (trajectory_frame_hash), the hash of its pixels (image_hash)
   and that of its bytes. No dates and no paths: the same runs and options give the same bytes.

   While pictures are drawn it grows as manifest.json.part, a line for each that is there, so that a program that was killed
   leaves what the next needs to go on. Neither file is trusted: a line counts only where it is, but for its own two
   hashes, the line that belongs there. */
#pragma once
#include "picture/picture.h"
#include "render/moments.h"

#include <stdio.h>

typedef struct Manifest {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    int first, last;       /* pictures, both included */
    char *path, *journal;  /* of manifest.json and of what it grows as */
    char *head;            /* its text up to the first line of a picture */
    PictureHashes *hashes; /* [last - first + 1] */
    bool *known;           /* [last - first + 1]: there are hashes */
    bool holds;            /* manifest.json is of these pictures */
    FILE *out;             /* the journal */
} Manifest;

/* For these pictures of options->directory, which is there. What it points to must outlive it. */
bool manifest_open(Manifest *manifest, const Picture *picture, const RenderOptions *options, const MomentPlan *plan,
                   int first, int last, Error *error);
void manifest_close(Manifest *manifest);

/* Learns the hashes of an earlier call that was to draw the same; else says why there are none. */
void manifest_recall(Manifest *manifest, char *why, size_t size);

/* Begins the journal with what is known. What is there of other pictures goes; ERROR_INPUT where a file of that name is no
   manifest of ours. */
bool manifest_begin(Manifest *manifest, Error *error);

/* A picture is there. */
bool manifest_add(Manifest *manifest, int index, PictureHashes hashes, Error *error);

/* All are: puts manifest.json in place of the journal. */
bool manifest_end(Manifest *manifest, Error *error);
