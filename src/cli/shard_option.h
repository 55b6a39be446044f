/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The option --shard of commands whose work can be done in pieces (pieces/pieces.h). */
#pragma once
#include "cli/options.h"
#include "pieces/pieces.h"

/* The row of a command's table; member: a text, NULL if it is not given. */
#define OPTION_SHARD(T, member)                                                                                      \
    "--shard", 0, "I/N", "Do share I of N only; 'twinbox merge' joins them (default: as Slurm or MPI says, or all)", \
        OPTION_TEXT(T, member)

/* How the command is to run: as a merge, a shard or the whole. A note tells what the environment says. argv must last. */
bool shard_option_take(PiecesRun *run, const char *option, int argc, char **argv, Error *error);

/* The result of a shard: "shard 3 of 16: 30 pieces ...". output: as given to pieces_open(). */
void shard_option_print(const Pieces *pieces, const char *output);

/* The next command that runs is a merge. */
void shard_option_merge(const PiecesRun *run);
bool shard_option_is_merge(void);
