/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Notes, the next command, and results that are kept back. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "cli/notes.h"
#include "cli/progress_bar.h"
#include "nets/kernels.h"
#include "runs/trajectory.h"

#include <omp.h>
#include <stdarg.h>
#include <stdlib.h>
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

static VisibleLines lines_of(const char *format) {
    return strchr(format, '\n') != NULL ? VISIBLE_LINES : VISIBLE_ONE_LINE;
}

/* What is done again and again, such as reading one network for each of many runs, is printed once. */
static void print_trace(const char *line) {
    enum { REMEMBERED = 4096 };
    static uint64_t hashes[REMEMBERED];
    static int count;
    const uint64_t hash = hash_xxh3(line, strlen(line));
#pragma omp critical(print_trace)
    {
        bool known = false;
        for (int i = 0; !known && i < count; i++) known = hashes[i] == hash;
        if (!known && count < REMEMBERED) hashes[count++] = hash;
        if (!known) print_line("", line, VISIBLE_ONE_LINE);
    }
}

void note_set_level(NoteLevel level) {
    chosen = level;
    trace_listen(level == NOTES_VERBOSE ? print_trace : NULL);
}

NoteLevel note_level(void) { return chosen; }

void note_print(const char *format, ...) {
    char text[2048];
    if (chosen == NOTES_QUIET) return;
    PRINT_ARGUMENTS(text, sizeof text, format);
    print_line("note: ", text, lines_of(format));
}

void note_verbose(const char *format, ...) {
    char text[2048];
    if (chosen != NOTES_VERBOSE) return;
    PRINT_ARGUMENTS(text, sizeof text, format);
    print_line("", text, lines_of(format));
}

void next_print(const char *const words[]) {
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:=,+-@%";
    if (chosen == NOTES_QUIET) return;
    fputs("next: twinbox", stdout);
    for (; *words != NULL; words++) {
        const char *word = *words;
        const bool quoted = word[strspn(word, plain)] != '\0';
        fputs(quoted ? " '" : " ", stdout);
        for (; *word != '\0'; word++) fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, stdout);
        if (quoted) putchar('\'');
    }
    putchar('\n');
}

NextPath next_path(const char *name, const char *ending) {
    NextPath path = {"out/"};
    char *begin = path.text + strlen(path.text);
    snprintf(begin, TRAJECTORY_NAME_SIZE, "%s", name);
    file_name_clean(begin);
    text_add(path.text, sizeof path.text, "%s", ending);
    return path;
}

void next_film(const char *path) {
    char name[TRAJECTORY_NAME_SIZE];
    trajectory_name_from_path(path, name);
    next_print((const char *const[]){"render", path, "-o", next_path(name, "").text, "--video",
                                     next_path(name, ".mp4").text, NULL});
}

/* Standard output, while results are kept back. */
static struct {
    FILE *output;
    char *text;
    size_t size;
} kept;

void results_keep(void) {
    FILE *stream = kept.output == NULL ? memory_stream(&kept.text, &kept.size) : NULL;
    if (stream == NULL) return;
    kept.output = stdout;
    stdout = stream; /* the GNU C library lets a program change it */
}

void results_end(bool print) {
    if (kept.output == NULL) return;
    fclose(stdout);
    stdout = kept.output;
    if (print) fwrite(kept.text, 1, kept.size, stdout);
    free(kept.text);
    kept.output = NULL;
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
