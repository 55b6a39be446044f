/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of rendering: frame texts, workers, videos, manifests. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <stdint.h>

/* Text entries of a picture's PNG file that state its origin. No date: the same picture gives the same file. */

enum {
    FRAME_TEXTS_MAX = 7,
    FRAME_METHODS_SIZE = RENDER_PANELS_MAX * (TRAJECTORY_NAME_SIZE + 3),
    FRAME_STATES_SIZE = RENDER_PANELS_MAX * 20
};

/* `entries` point into this struct. */
typedef struct FrameTexts {
    char methods[FRAME_METHODS_SIZE], frame[16], part[16], states[FRAME_STATES_SIZE], networks[FRAME_STATES_SIZE];
    ImageText entries[FRAME_TEXTS_MAX];
    int count;
} FrameTexts;

/* Fills in Scene, Method, Frame, State (all panels joined) and Software; for interpolated pictures also "Part", for
   cards "Card", and where a method has a network "Network". */
void frame_texts_fill(FrameTexts *texts, const Picture *picture, Moment moment);

/* The interpolated position, as "1/4". */
void frame_part_text(char *text, size_t size, Moment moment);

/* manifest.json lists a sequence: what was drawn (version, runs, look, order), where in the pictures it is
   and, one line per file, the frame it shows, the runs' state hashes there (trajectory_frame_hash), the
   hash of its pixels (image_hash) and of its bytes.
   No dates and no paths: the same runs and options give the same bytes. During drawing it is a journal,
   manifest.json.part, with a line per finished picture, so that a later call can resume after a kill. Neither file
   is trusted: a line is used only if all but its two hashes equals the expected line. */

typedef struct Manifest {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    int first, last;       /* pictures, inclusive */
    char *head;            /* its text before the first picture */
    PictureHashes *hashes; /* [last - first + 1], and in the same block: */
    bool *known;           /* [last - first + 1], whether the hashes are set */
    char *path, *journal;  /* paths of manifest.json and of its journal */
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
   also the frames of an earlier one that would remain. */
bool manifest_begin(Manifest *manifest, bool whole, Error *error);

/* Records a finished picture; without a journal, in memory alone. */
bool manifest_add(Manifest *manifest, int index, PictureHashes hashes, Error *error);

/* Replaces the journal by manifest.json. */
bool manifest_end(Manifest *manifest, Error *error);

/* A picture's line, without indentation and comma, for file_print(). The context is a ManifestLine. */
typedef struct ManifestLine {
    const Manifest *manifest;
    int index;
    PictureHashes hashes;
} ManifestLine;
void manifest_print_line(FILE *out, const void *line);

/* Bytes of the longest line of a picture. */
enum { MANIFEST_LINE_SIZE = 640 };

/* Distributes pictures over processes and reads their reports. Processes rather than threads, as Mesa rasterises one
   screen at a time per process. They are forked before any OpenGL context is created: a context does not survive a
   fork. */

typedef struct WorkerJob {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    Manifest *manifest; /* known pictures whose files are unchanged are kept */
    int first, last;    /* pictures, inclusive */
} WorkerJob;

/* Draws or keeps the pictures of the job, by as many processes as its options say, and adds them to its manifest. Then
   the files are safely on the disk. *kept: how many were kept. ERROR_INTERRUPTED if progress requests a stop. */
bool workers_draw(const WorkerJob *job, int *kept, const Progress *progress, Error *error);

/* The part of renderer.c that the workers of a sequence use. */

/* Like renderer_create(), for a picture that is already planned. */
Renderer *renderer_create_planned(const Picture *picture, const RenderOptions *options, Error *error);

/* Draws the next moment of a sequence into the image of the previous call. Only rows that differ are painted and
   read back; *changed has a flag per row. The first call draws all. */
bool renderer_draw_next(Renderer *renderer, Moment moment, Image *image, const bool **changed, Error *error);
