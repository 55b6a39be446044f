/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands of twinbox. Each is one file, with its option table and glue only, and one line here. */
#pragma once
#include "common/error.h"

#include <stddef.h>

#define COMMANDS(COMMAND)                                                          \
    COMMAND(new, "write a commented scene to start from")                          \
    COMMAND(check, "validate a scene and draw its first frame")                    \
    COMMAND(simulate, "run a scene with one method and store the trajectory")      \
    COMMAND(render, "draw runs side by side as PNG frames and videos")             \
    COMMAND(page, "write a page that plays runs side by side in a browser")        \
    COMMAND(compare, "compare two trajectories or two PNG sequences")              \
    COMMAND(approve, "accept the changes that a report of compare shows")          \
    COMMAND(diverge, "find why two trajectories diverge, and how fast")            \
    COMMAND(figure, "draw a figure for a paper from runs")                         \
    COMMAND(import, "store the run of another program, from CSV")                  \
    COMMAND(export, "write a run as CSV, JSON or a script for Blender")            \
    COMMAND(dataset, "record what the engine's solver does to each touching pair") \
    COMMAND(train, "train the network of a method")                                \
    COMMAND(chart, "measure speed against accuracy for every method")              \
    COMMAND(paper, "reproduce the paper, from seed to report")                     \
    COMMAND(stability, "find where each method fails")                             \
    COMMAND(merge, "join what the shards of a study did")                          \
    COMMAND(problem, "write the contact problem of one step to a file")            \
    COMMAND(solve, "solve one contact problem with many methods and score them")   \
    COMMAND(methods, "list the methods and their settings")                        \
    COMMAND(completion, NULL)

typedef struct Command {
    const char *name, *summary; /* summary NULL: not listed */
    /* True: done and equal (exit status 0). False: different (1) or, with error set, failed: the caller prints the error
       and exits with its kind. argv[0] is "twinbox NAME". Bad options and --help end the program from within argp. */
    bool (*run)(int argc, char **argv, Error *error);
} Command;

/* All commands, ended by a NULL name. */
extern const Command commands[];

#define COMMAND_DECLARED(name, summary) bool command_##name(int argc, char **argv, Error *error);
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED
