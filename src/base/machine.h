/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The machine and the process: memory, clocks, work on all threads or on a second one, its progress, and programs that
   are run. */
#pragma once
#include "base/base.h"

#include <stdio.h>
#include <sys/types.h>

/* The processor's model, as the system names it, in plain characters of ASCII: "Intel(R) Xeon(R) CPU @ 2.20GHz"; else
   the architecture. */
enum { CPU_NAME_SIZE = 96 };
void cpu_name(char name[CPU_NAME_SIZE]);

/* The limit that a shell or a service sets on the memory of a process: the likely reason where a library fails without
   giving one. */

typedef struct MemoryLimit {
    char text[80]; /* "; the memory of a process is limited to 200 MiB (ulimit -v)"; empty without a limit */
} MemoryLimit;

MemoryLimit memory_limit(void);

/* Progress reports of long work. The library never prints: cli/ supplies the bar. */

typedef struct Progress {
    /* Called repeatedly, never from two threads at once; returns false to stop the work early. */
    bool (*report)(void *context, double done, double total);
    void *context;
} Progress;

/* True to continue; always true for a NULL progress. */
static inline bool progress_report(const Progress *progress, double done, double total) {
    return progress == NULL || progress->report(progress->context, done, total);
}

/* A stage of longer work: it covers `share` of the whole, from `begin` on. The context of a Progress whose function is
   progress_stage. */
typedef struct ProgressStage {
    const Progress *whole; /* may be NULL */
    double begin, share;   /* 0 to 1 */
    bool stopped;          /* a stop was requested; `whole` is not called again */
} ProgressStage;

static inline bool progress_stage(void *context, double done, double total) {
    ProgressStage *stage = (ProgressStage *)context;
    stage->stopped = stage->stopped || !progress_report(stage->whole, stage->begin + stage->share * done / total, 1);
    return !stage->stopped;
}

/* The next stage begins where this one ends. */
static inline void progress_next_stage(ProgressStage *stage, double share) {
    stage->begin += stage->share;
    stage->share = share;
}

/* Runs many independent pieces of work on all threads (OpenMP). */

typedef struct ParallelWork {
    /* Does piece i; called from several threads at once. False with error set stops those behind it. */
    bool (*piece)(void *context, int i, Error *error);
    void *context;
} ParallelWork;

/* Does pieces 0 .. count - 1 in any order and reports each to progress. False with the error of the least piece that
   fails, for any number of threads, or with "what: error: stopped after ..." if progress requests a stop. */
bool parallel_for(const ParallelWork *work, int count, const char *what, const Progress *progress, Error *error);

/* Seconds of a clock that never steps back. */
double clock_seconds(void);

/* Processor time of the calling thread: other programs do not count. */
double clock_thread_seconds(void);

/* A second thread that works on one item after the other, in the order in which they are given, while the caller makes
   the next. */

typedef struct Background Background;

/* Called in the second thread. After a failure it is not called again. */
typedef bool BackgroundWork(void *context, void *item, Error *error);

Background *background_start(BackgroundWork *work, void *context, Error *error);

/* Waits until the item before is done, then gives the next. False with the error of an earlier item: then it is not
   taken. The item must last until the next call returns. */
bool background_give(Background *background, void *item, Error *error);

/* Waits until all items are done; with the first error. */
bool background_wait(Background *background, Error *error);

/* Ends the thread when its item is done. */
void background_stop(Background *background);

/* Runs another program and writes to its standard input, without a shell. Own code: popen() needs a shell, and a
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

/* Talks with another program, which answers on its standard output, without a shell. It has a process group of its own,
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
