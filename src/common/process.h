/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Another program, fed through its standard input. No shell is involved. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

typedef struct Process {
    const char *name;
    pid_t pid;
    int input;    /* connected to its standard input */
    FILE *output; /* what it writes to standard output and error */
} Process;

/* Starts argv[0], found in PATH; argv ends with NULL and must outlive the process. ERROR_SYSTEM where it is
   missing. */
bool process_start(Process *process, const char *const *argv, Error *error);

/* False where the program does not read any more; what it says comes from process_finish. */
bool process_write(Process *process, const void *data, size_t size);

/* Closes its input, waits, and puts what it wrote (cut to size - 1 bytes) into text. ERROR_SYSTEM, with that text,
   where it did not exit with 0. */
bool process_finish(Process *process, char *text, size_t size, Error *error);

/* Ends it at once. */
void process_kill(Process *process);
