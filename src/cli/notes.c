/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Standard error and signals: notes, interrupts, the time that is left, the progress bar. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "nets/kernels.h"
#include "runs/trajectory.h"

#include <omp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static NoteLevel chosen = NOTES_NORMAL;
static double begun; /* s */

/* One call, so that lines of several processes do not mix. */
static void print_line(const char *kind, const char *line, VisibleLines lines) {
    char shown[2048];
    visible_text(shown, sizeof shown, line, lines);
    progress_bar_clear();
    fprintf(stderr, "twinbox: %s%s\n", kind, shown);
}

PRINTF_LIKE(2, 0) static void print(const char *kind, const char *format, va_list arguments) {
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

static void print_word(const char *word) {
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:=,+-@%";
    putchar(' ');
    if (word[strspn(word, plain)] == '\0') {
        fputs(word, stdout);
        return;
    }
    putchar('\'');
    for (; *word != '\0'; word++) fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, stdout);
    putchar('\'');
}

void next_print(const char *const words[]) {
    if (chosen == NOTES_QUIET) return;
    fputs("next: twinbox", stdout);
    for (; *words != NULL; words++) print_word(*words);
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

/* The handler and threads of parallel work use both: only lock-free atomics are defined there. */
static atomic_bool requested;
static atomic_int held;
static atomic_llong requested_at; /* ms */
_Static_assert(ATOMIC_BOOL_LOCK_FREE == 2 && ATOMIC_INT_LOCK_FREE == 2 && ATOMIC_LLONG_LOCK_FREE == 2,
               "a signal handler may wait for a lock");

/* timeout(1) and schedulers send a signal to the process and then to its group: that is one request. */
enum { SAME_REQUEST = 1000 /* ms */ };

static void on_signal(int signal_number) {
    static const char text[] = "twinbox: error: interrupted\n";
    (void)signal_number;
    const long long now = (long long)(1000 * clock_seconds()); /* by a call that handlers may make */
    const bool first = !atomic_exchange(&requested, true);
    if (first) atomic_store(&requested_at, now);
    if (atomic_load(&held) > 0 && (first || now - atomic_load(&requested_at) < SAME_REQUEST)) return;
    const ssize_t ignored = write(STDERR_FILENO, text, sizeof text - 1);
    (void)ignored;
    talks_kill();
    _exit(ERROR_INTERRUPTED);
}

void interrupt_handle(void) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction hangup;
    if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) /* nohup(1) */
        sigaction(SIGHUP, &action, NULL);
}

void interrupt_hold(void) { atomic_fetch_add(&held, 1); }

void interrupt_release(void) { atomic_fetch_sub(&held, 1); }

bool interrupt_requested(void) { return atomic_load(&requested); }

void interrupt_forget(void) { atomic_store(&requested, false); }

/* s; share of the time so far */
static const double least_window = 4, window_share = 1.0 / 3, first_spacing = 0.05;
static const double least_time = 2, least_part = 0.02, patience = 20, least_ever = 0.002, agreement = 2;

void time_left_begin(TimeLeft *left) {
    *left = (TimeLeft){.count = 1, .spacing = first_spacing}; /* the first sample: nothing done at 0 s */
}

static void thin(TimeLeft *left) {
    for (int i = 1; 2 * i < left->count; i++) left->samples[i] = left->samples[2 * i];
    left->count = (left->count + 1) / 2;
    left->spacing *= 2;
}

void time_left_add(TimeLeft *left, double time, double part) {
    if (time < left->samples[left->count - 1].time + left->spacing) return;
    if (left->count == TIME_LEFT_SAMPLES) thin(left);
    left->samples[left->count++] = (struct TimeLeftSample){time, part};
}

/* The part that was done at a time, between samples along a line from one to the next. */
static double part_at(const TimeLeft *left, const struct TimeLeftSample *now, double time) {
    struct TimeLeftSample before = left->samples[0], after = *now;
    for (int i = 0; i < left->count; i++) {
        if (left->samples[i].time > time) {
            after = left->samples[i];
            break;
        }
        before = left->samples[i];
    }
    if (after.time <= before.time) return before.part;
    return before.part + (after.part - before.part) * (time - before.time) / (after.time - before.time);
}

bool time_left_estimate(const TimeLeft *left, double time, double part, double *seconds) {
    if (time < least_time || part < (time < patience ? least_part : least_ever)) return false;
    double window = time * window_share > least_window ? time * window_share : least_window;
    if (window > time) window = time;
    const struct TimeLeftSample now = {time, part};
    const double begin = part_at(left, &now, time - window), middle = part_at(left, &now, time - window / 2);
    const double first = middle - begin, second = part - middle;
    if (first <= 0 || second <= 0 || first > agreement * second || second > agreement * first) return false;
    *seconds = part < 1 ? (1 - part) * window / (part - begin) : 0;
    return true;
}

void time_left_text(double seconds, char text[TIME_LEFT_TEXT_SIZE]) {
    const double most = 1e6; /* s */
    const int rounded = (int)((seconds < most ? seconds : most) + 0.5), whole = rounded < 1 ? 1 : rounded;
    const int tens = (whole + 5) / 10 * 10, minutes = (whole + 30) / 60, ten_minutes = (minutes + 5) / 10 * 10;
    if (whole < 60)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d s", whole);
    else if (tens < 600)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d min %02d s", tens / 60, tens % 60);
    else if (minutes < 60)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d min", minutes);
    else
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d h %02d min", ten_minutes / 60, ten_minutes % 60);
}

/* There is one terminal: one bar at a time. */
static struct {
    char what[192];
    double begun, shown;          /* s */
    double last;                  /* part that was shown last */
    bool held, visible, terminal; /* held: signals wait for the work */
    TimeLeft left;
} bar;

static void show(double part, double elapsed) {
    enum { WIDTH = 30 };
    char left[TIME_LEFT_TEXT_SIZE] = "";
    double seconds = 0;
    const bool known = part < 1 && time_left_estimate(&bar.left, elapsed, part, &seconds);
    if (known) time_left_text(seconds, left);
    const char *comma = known ? ", " : "", *behind = known ? " left" : "";
    if (!bar.terminal) {
        fprintf(stderr, "%s: %.0f%%%s%s%s\n", bar.what, 100 * part, comma, left, behind);
        return;
    }
    char cells[WIDTH + 1];
    memset(cells, '.', WIDTH);
    memset(cells, '#', (size_t)(part * WIDTH));
    cells[WIDTH] = '\0';
    fprintf(stderr, "\r\033[K%s [%s] %3.0f%%%s%s%s", bar.what, cells, 100 * part, comma, left, behind);
    fflush(stderr);
}

static bool report(void *context, double done, double total) {
    (void)context;
    /* Not before: work that waits for its input does not look at what this returns. */
    if (!bar.held) interrupt_hold();
    bar.held = true;
    const double time = clock_seconds(), elapsed = time - bar.begun, pause = bar.terminal ? 0.1 : 5.0;
    const double part = done < total ? done / total : 1.0;
    time_left_add(&bar.left, elapsed, part);
    /* The last line in a file is the end, however soon it comes after the one before. */
    const bool ends = part == 1 && bar.visible && bar.last < 1 && !bar.terminal;
    if (note_level() > NOTES_QUIET && elapsed >= 1.0 && (time - bar.shown >= pause || ends) && done > 0) {
        bar.shown = time;
        bar.last = part;
        bar.visible = true;
        show(part, elapsed);
    }
    return !interrupt_requested();
}

const Progress *progress_bar_begin(const char *what) {
    static const Progress progress = {report, NULL};
    progress_bar_clear();
    bar.visible = false; /* signals stay held from one stage of a work to the next */
    bar.begun = clock_seconds();
    bar.shown = 0;
    time_left_begin(&bar.left);
    bar.terminal = isatty(STDERR_FILENO) == 1;
    snprintf(bar.what, sizeof bar.what, "%s", what);
    return &progress;
}

void progress_bar_clear(void) {
    if (bar.visible && bar.terminal) fputs("\r\033[K", stderr);
}

void progress_bar_end(void) {
    progress_bar_clear();
    bar.visible = false;
    if (bar.held) interrupt_release();
    bar.held = false;
}
