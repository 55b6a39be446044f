/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a command prints on standard error beside its errors. The options -q and -v, which every command has, set the
   level; results and errors do not depend on it. */
#pragma once
#include "common/error.h"

typedef enum NoteLevel { NOTES_QUIET, NOTES_NORMAL, NOTES_VERBOSE } NoteLevel;

/* With NOTES_VERBOSE, the lines of common/trace.h are printed, too, equal ones once. */
void note_set_level(NoteLevel level);
NoteLevel note_level(void);

/* "twinbox: note: TEXT": what the user should know about the result. Not with -q. */
void note_print(const char *format, ...) PRINTF_LIKE(1, 2);

/* "twinbox: TEXT": how the result came about. Only with -v. */
void note_verbose(const char *format, ...) PRINTF_LIKE(1, 2);

/* With -v: version, threads and instruction set before the work; time and memory after it. */
void note_begin(const char *command);
void note_end(void);
