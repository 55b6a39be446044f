/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/notes.h"

#include "cli/progress_bar.h"
#include "common/clock.h"
#include "common/hash.h"
#include "common/trace.h"
#include "common/visible_text.h"
#include "network/kernels.h"

#include <omp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static NoteLevel chosen = NOTES_NORMAL;
static double begun; /* s */

/* One call, so that lines of several processes do not mix. */
static void print_line(const char *kind, const char *line, VisibleLines lines) {
    char shown[2048];
    visible_text(shown, sizeof shown, line, lines);
    progress_bar_clear();
    fprintf(stderr, "twinbox: %s%s\n", kind, shown);
}

static void print(const char *kind, const char *format, va_list arguments) PRINTF_LIKE(2, 0);

static void print(const char *kind, const char *format, va_list arguments) {
    char text[2048];
    vsnprintf(text, sizeof text, format, arguments);
    print_line(kind, text, strchr(format, '\n') != NULL ? VISIBLE_LINES : VISIBLE_ONE_LINE);
}

/* What is done again and again, such as reading one network for each of many runs, is printed once. */
static bool is_new(const char *line) {
    enum { REMEMBERED = 4096 };
    static uint64_t hashes[REMEMBERED];
    static int count;
    const uint64_t hash = hash_xxh3(line, strlen(line));
    for (int i = 0; i < count; i++)
        if (hashes[i] == hash) return false;
    if (count < REMEMBERED) hashes[count++] = hash;
    return true;
}

static void print_trace(const char *line) {
#pragma omp critical(print_trace)
    if (is_new(line)) print_line("", line, VISIBLE_ONE_LINE);
}

void note_set_level(NoteLevel level) {
    chosen = level;
    trace_listen(level == NOTES_VERBOSE ? print_trace : NULL);
}

NoteLevel note_level(void) { return chosen; }

void note_print(const char *format, ...) {
    va_list arguments;
    if (chosen == NOTES_QUIET) return;
    va_start(arguments, format);
    print("note: ", format, arguments);
    va_end(arguments);
}

void note_verbose(const char *format, ...) {
    va_list arguments;
    if (chosen != NOTES_VERBOSE) return;
    va_start(arguments, format);
    print("", format, arguments);
    va_end(arguments);
}

void note_begin(const char *command) {
    const int threads = omp_get_max_threads();
    begun = clock_seconds();
    note_verbose("%s, version " TWINBOX_VERSION ", %d thread%s, %s instructions", command, threads,
                 threads == 1 ? "" : "s", kernels_best()->name);
}

static double processor_seconds(const struct rusage *usage) {
    return (double)(usage->ru_utime.tv_sec + usage->ru_stime.tv_sec) +
           1e-6 * (double)(usage->ru_utime.tv_usec + usage->ru_stime.tv_usec);
}

void note_end(void) {
    struct rusage own, children;
    if (chosen != NOTES_VERBOSE || getrusage(RUSAGE_SELF, &own) != 0 || getrusage(RUSAGE_CHILDREN, &children) != 0)
        return;
    const long most = own.ru_maxrss > children.ru_maxrss ? own.ru_maxrss : children.ru_maxrss; /* KiB */
    note_verbose("%.3f s, %.3f s of processor time, at most %.1f MiB in a process", clock_seconds() - begun,
                 processor_seconds(&own) + processor_seconds(&children), (double)most / 1024);
}
