/* SPDX-License-Identifier: GPL-3.0-or-later */
/* -DTWINBOX_PARTS=compare: the table of the commands, and what stands for the rooms that this build leaves out. */
#include "base/base.h"
#include "cli/cli.h"
#include "cli/larger_commands.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "nets/kernels.h"
#include "pictures/player.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"

static const char only[] = "this build has compare only, for pictures; the package twinbox has the rest";

const char program_summary[] = "Visual regression. This build has compare only, for pictures.";
const char program_begin[] = "twinbox compare expected actual --report report";

static bool missing(int argc, char **argv, Error *error) {
    (void)argc;
    return error_input(error, argv[0], "%s", only);
}

/* The first of a name is found, and those without a summary are not listed. */
#define COMMAND_MISSING(name, summary, heading) {#name, NULL, NULL, missing},
const Command commands[] = {{"compare", "find where two PNG sequences differ", "Compare", command_compare},
                            {"approve", "accept the changes that a report of compare shows", NULL, command_approve},
                            COMMANDS(COMMAND_MISSING){0}};

bool compare_runs(const CompareOptions *options, Error *error) {
    return error_input(error, options->paths[0], "%s", only);
}

Trajectory *csv_trace_read(const char *path, Error *error) { return error_input(error, path, "%s", only), NULL; }

bool compare_many(const CompareOptions *options, Error *error) { return compare_runs(options, error); }

/* So that a folder's .npz files are counted as not compared (regression/comparison_words.c). */
Trajectory *trajectory_read(const char *path, Error *error) { return error_input(error, path, "%s", only), NULL; }

/* Without runs, reports have no pages of them. */
bool player_write(const Trajectory *const *runs, int count, const PlayerOptions *options, const char *path,
                  PlayerResult *result, Error *error) {
    (void)runs, (void)count, (void)options, (void)result;
    return error_input(error, path, "%s", only);
}

void player_link(char text[PLAYER_LINK_SIZE], double time, int body) {
    (void)time, (void)body;
    text[0] = '\0';
}

void print_contexts(FILE *file) { fprintf(file, "%s\n", only); }

void programs_allow(const char *methods) { (void)methods; }

const Kernels *kernels_best(void) {
    static const Kernels standard = {.name = "standard"};
    return &standard;
}
