/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs another program and writes to its standard input, without a shell. Own code: popen() needs a shell, and a
   program that stops reading would end this one by SIGPIPE (tests/common/test_process.c). */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

typedef struct Process {
    const char *name;
    pid_t pid;
    int input;    /* connected to its standard input */
    FILE *output; /* its standard output and error */
    bool missing; /* there is no such program */
    int unsent;   /* errno, if the system kept input from it; 0: none */
} Process;

/* Starts argv[0], found in PATH; argv ends with NULL and must outlive the process. ERROR_SYSTEM if it is missing. */
bool process_start(Process *process, const char *const *argv, Error *error);

/* False if the program no longer reads, or the system fails; process_finish() then returns its output, or the reason. */
bool process_write(Process *process, const void *data, size_t size);

/* Closes its input, waits, and copies its output (cut to size - 1 bytes) into text. ERROR_SYSTEM with that text unless
   it exits with 0. */
bool process_finish(Process *process, char *text, size_t size, Error *error);

/* Kills it. */
void process_kill(Process *process);
