/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other programs, run without a shell:

     Process process;
     if (process_start(&process, (const char *const[]){"cat", NULL}, &error)) {
         process_write(&process, "text", 4);
         process_finish(&process, text, sizeof text, &error);
     } */
#pragma once
#include "base/base.h"

#include <stdio.h>
#include <sys/types.h>

/* Runs another program and writes to its standard input. Own code: popen() needs a shell, and a
   program that stops reading would end this one by SIGPIPE (tests/base/test_process.c). */

typedef struct Process {
    const char *name;
    pid_t pid;
    int input;    /* connected to its standard input */
    FILE *output; /* its standard output and error */
    int unsent;   /* errno, if the system kept input from it; 0: none */
} Process;

/* Starts argv[0], found in PATH; argv ends with NULL and must outlive the process. ERROR_SYSTEM if it is missing. */
bool process_start(Process *process, const char *const *argv, Error *error);

/* False if the program no longer reads, or the system fails; process_finish() then returns its output, or the
   reason. */
bool process_write(Process *process, const void *data, size_t size);

/* Closes its input, waits, and copies its output (cut to size - 1 bytes) into text. ERROR_SYSTEM with that text unless
   it exits with 0. */
bool process_finish(Process *process, char *text, size_t size, Error *error);

/* Kills it. */
void process_kill(Process *process);

/* Talks with another program, which answers on its standard output. It has a process group of its own,
   which ends as a whole. Nothing here but talk_end() waits longer than `until`, by clock_seconds(), or takes more
   memory than it is told. */

enum { TALK_WHY_SIZE = 400, TALK_COMPLAINT_SIZE = 4096 };

typedef struct Talk {
    pid_t pid;
    int input, output,
        complaints; /* connected to its standard input, output and error; complaints -1: it closed that one */
    char *unread;   /* [end] of its output, from `begin` on */
    size_t begin, end, capacity;
    char complaint[TALK_COMPLAINT_SIZE]; /* what it wrote to standard error first; the rest is read and forgotten */
    size_t complaint_size;
    char why[TALK_WHY_SIZE]; /* after a failure: what it did, "has ended (status 1)" */
} Talk;

/* Starts argv[0], found in PATH; argv ends with NULL. After a failure there is nothing to end. */
bool talk_start(Talk *talk, const char *const *argv);

/* Sends all of it, while the program reads. */
bool talk_send(Talk *talk, const void *data, size_t size, double until);

/* The next `size` bytes of its answer, or its next line, ended by NUL instead of its line end (LF or CRLF) and of at
   most `most` bytes; valid until the next call. NULL after a failure. */
char *talk_read(Talk *talk, size_t size, double until);
char *talk_line(Talk *talk, size_t most, double until);

/* Whether it runs, and has written nothing that was not read. */
bool talk_is_quiet(Talk *talk);

/* Kills the program and all of its process group; waits 2 s at most for its end. */
void talk_end(Talk *talk);

/* Kills all programs that talk. A handler of signals may call it, before it ends the process. */
void talks_kill(void);
