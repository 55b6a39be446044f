/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have. */
#pragma once
#include "base/base.h"
#include "cli/options.h"
#include "runs/framing.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <stdbool.h>
#include <stdint.h>

/* The option --frames A:B of commands that show runs. */

typedef struct FrameRange {
    int first, last; /* inclusive; last -1: to the end */
} FrameRange;

/* "A:B", ":B", "A:" or "A"; `value` is a FrameRange. */
OptionRead frames_option_read;

/* Splits text at the first `separator` into two whole numbers. An empty part leaves its number unchanged. */
bool frames_option_split(const char *text, char separator, int minimum, int maximum, int64_t numbers[2]);

/* The options --camera X,Y,W,H and --view-from RUN of pictures and figures. */

#define CAMERA_OPTION_VIEW "X,Y,W,H: the view around the point (X, Y), W wide and H high, in metres"

/* An option's value "X,Y,W,H". */
bool camera_option_read(const Option *option, const char *text, void *view, Error *error);

/* Reads the run of --view-from, which the caller destroys; NULL if there is no `path`. ERROR_INPUT beside a view. */
bool camera_option_load(const char *path, const CameraView *view, Trajectory **run, Error *error);

/* The option --shard of commands whose work can be done in pieces (runs/pieces.h). */

/* The row of a command's table; member: a text, NULL if it is not given. */
#define OPTION_SHARD(T, member)                                                                                      \
    "--shard", 0, "I/N", "Do share I of N only; 'twinbox merge' joins them (default: as Slurm or MPI says, or all)", \
        OPTION_TEXT(T, member)

/* How the command is to run: as a merge, a shard or the whole. A note tells what the environment says. argv must
   last. */
bool shard_option_take(PiecesRun *run, const char *option, int argc, char **argv, Error *error);

/* The result of a shard: "shard 3 of 16: 30 pieces ...". output: as given to pieces_open(). */
void shard_option_print(const Pieces *pieces, const char *output);

/* The next command that runs is a merge. */
void shard_option_merge(const PiecesRun *run);
