/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a command prints on standard error beside its errors. The options -q and -v, which every command has, set the
   level; errors do not depend on it, nor do results that go to no file. */
#pragma once
#include "base/base.h"
#include "runs/trajectory.h"

#include <stdbool.h>

typedef enum NoteLevel { NOTES_QUIET, NOTES_NORMAL, NOTES_VERBOSE } NoteLevel;

/* With NOTES_VERBOSE, the lines of base/base.h are printed, too, equal ones once. */
void note_set_level(NoteLevel level);
NoteLevel note_level(void);

/* "twinbox: note: TEXT": what the user should know about the result. Not with -q. */
void note_print(const char *format, ...) PRINTF_LIKE(1, 2);

/* "twinbox: TEXT": how the result came about. Only with -v. */
void note_verbose(const char *format, ...) PRINTF_LIKE(1, 2);

/* "next: twinbox WORD...", which ends with NULL, on standard output: what to type next. Words are quoted for a shell.
   Not with -q. */
void next_print(const char *const words[]);

/* "out/NAME" and the ending: for what the next command writes. */
typedef struct NextPath {
    char text[TRAJECTORY_NAME_SIZE + 32];
} NextPath;
NextPath next_path(const char *name, const char *ending);

/* To render a scene or a run as a film: "next: twinbox render wall.yaml -o out/wall --video out/wall.mp4". */
void next_film(const char *path);

/* Keeps back what is printed on standard output from now on. With -q, of commands whose results are files; main()
   prints it if the command does not succeed. */
void results_keep(void);
void results_end(bool print);

/* With -v: version, threads and instruction set before the work; time and memory after it. */
void note_begin(const char *command);
void note_end(void);
