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

/* The option --shard of commands whose work is done in pieces (runs/pieces.h). */

/* The row of a command's table; member: a Shard. */
#define OPTION_SHARD(T, member)                                                                                 \
    "--shard", 0, "K/N",                                                                                        \
        "Do every N-th piece of the work from the K-th on, and stop; the same command without it does what is " \
        "missing and writes the results",                                                                       \
        OPTION_READ(shard_option_read, T, member)

OptionRead shard_option_read;

/* The result of a shard: "shard 3 of 16: 30 pieces ...". */
void shard_option_print(const Pieces *pieces);
