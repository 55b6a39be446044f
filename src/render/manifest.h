/* SPDX-License-Identifier: GPL-3.0-or-later */
/* manifest.json lists a sequence: what was drawn (version, runs, look, order), where in the pictures it is
   (manifest_view.h) and, one line per file, the frame it shows, the runs' state hashes there (trajectory_frame_hash), the
   hash of its pixels (image_hash) and of its bytes.
   No dates and no paths: the same runs and options give the same bytes. During drawing it is a journal,
   manifest.json.part, with a line per finished picture, so that a later call can resume after a kill. Neither file
   is trusted: a line is used only if all but its two hashes equals the expected line. */
#pragma once
#include "picture/picture.h"
#include "render/moments.h"

typedef struct Manifest {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    int first, last;       /* pictures, inclusive */
    char *path, *journal;  /* paths of manifest.json and of its journal */
    char *head;            /* its text before the first picture */
    PictureHashes *hashes; /* [last - first + 1] */
    bool *known;           /* [last - first + 1], whether the hashes are set */
    bool valid;            /* manifest.json is of these pictures */
    int out;               /* the journal; -1: none */
} Manifest;

/* Plans the manifest of these pictures in options->directory. All pointers must outlive the
   manifest. */
bool manifest_open(Manifest *manifest, const Picture *picture, const RenderOptions *options, const MomentPlan *plan,
                   int first, int last, Error *error);
void manifest_close(Manifest *manifest);

/* Reads the hashes of an earlier call with the same runs and options; otherwise sets `why`. */
void manifest_recall(Manifest *manifest, char *why, size_t size);

/* ERROR_INPUT if a file of its name or its journal's is not a manifest of twinbox. */
bool manifest_check(const Manifest *manifest, Error *error);

/* Starts the journal with the known pictures and removes a manifest of other pictures; if the sequence is a whole run,
   also the frames of an earlier one that would remain (stale.h). Errors of manifest_check(), too. */
bool manifest_begin(Manifest *manifest, bool whole, Error *error);

/* Records a finished picture; without a journal, in memory alone. */
bool manifest_add(Manifest *manifest, int index, PictureHashes hashes, Error *error);

/* Replaces the journal by manifest.json. */
bool manifest_end(Manifest *manifest, Error *error);
