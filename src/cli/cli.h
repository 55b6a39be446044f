/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of the commands, and the scenes of `twinbox new`. */
#pragma once
#include "base/base.h"

#include <stdbool.h>
#include <stdio.h>

/* The commands of twinbox. Each is one file, with its option table and glue only, and one line here: name, summary, and
   the heading of the group that begins with it, or NULL. Help and manual page have these groups. */

#define COMMANDS(COMMAND)                                                                    \
    COMMAND(new, "write a commented scene to start from", "Make")                            \
    COMMAND(check, "validate a scene and draw its first frame, or judge a stored run", NULL) \
    COMMAND(simulate, "run a scene with one method and store the run", NULL)                 \
    COMMAND(methods, "list the methods and their settings", NULL)                            \
    COMMAND(import, "store the run of another program, from CSV", NULL)                      \
    COMMAND(render, "draw runs side by side as PNG frames and videos", "Look")               \
    COMMAND(page, "write a page that plays runs side by side in a browser", NULL)            \
    COMMAND(figure, "draw a figure for a paper from runs", NULL)                             \
    COMMAND(export, "write a run as CSV or JSON", NULL)                                      \
    COMMAND(compare, "find where and why two runs, or two PNG sequences, differ", "Compare") \
    COMMAND(approve, "accept the changes that a report of compare shows", NULL)              \
    COMMAND(chart, "measure speed against accuracy for every method", "Measure")             \
    COMMAND(stability, "find where each method fails", NULL)                                 \
    COMMAND(train, "train the network of a method", "Learn")                                 \
    COMMAND(dataset, "record what the engine's solver does to each touching pair", NULL)     \
    COMMAND(paper, "reproduce the paper, from seed to report", "For research on the method") \
    COMMAND(solve, "solve the contact problem of one step with many methods", NULL)

typedef struct Command {
    const char *name, *summary;
    const char *heading; /* of the group that begins with it; NULL: of the group of the command before it */
    /* True: done and equal (exit status 0). False: different (1) or, with error set, failed: the caller prints the
       error and exits with its kind. argv[0] is "twinbox NAME". Bad options and --help end the program from within
       argp. */
    bool (*run)(int argc, char **argv, Error *error);
} Command;

/* All commands, ended by a NULL name. For the help: what the program does, and a first command line. */
extern const Command commands[];
extern const char program_summary[], program_begin[];

#define COMMAND_DECLARED(name, summary, heading) bool command_##name(int argc, char **argv, Error *error);
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

/* The scenes of scenes/templates/, embedded in the binary, in the order of the help. */

#define TEMPLATES(TEMPLATE) \
    TEMPLATE(wall)          \
    TEMPLATE(stack)         \
    TEMPLATE(pyramid)       \
    TEMPLATE(arch) TEMPLATE(dominoes) TEMPLATE(towers) TEMPLATE(gate) TEMPLATE(cardhouse) TEMPLATE(pile)

#define TEMPLATE_DECLARED(name) extern const char template_##name##_yaml[];
TEMPLATES(TEMPLATE_DECLARED)
#undef TEMPLATE_DECLARED

/* What `twinbox --version -v` adds: what pictures are drawn by. */

/* A line for each kind of context: Mesa's version and rasteriser, or why it cannot be used. The one that `render` takes
   by default is marked. */
void print_contexts(FILE *file);
