/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What compare prints about pictures, and how it watches. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "cli/interrupt.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>

static const char *trajectories(int count) { return count == 1 ? "trajectory" : "trajectories"; }

/* The frames, or the trajectories, that only this folder has. */
static void print_alone(const Regression *regression, RegressionSide side, bool runs) {
    enum { NAMED = 10 };
    const PixelVerdict verdict = side == EXPECTED ? PIXELS_MISSING : PIXELS_EXTRA;
    const int all = runs ? regression->run_count : regression->count;
    const int count = runs ? regression->runs_alone[side] : regression->by_verdict[verdict];
    if (count == 0) return;
    printf("only in %s: %d %s%s:", regression->sequences[side]->folder, count, runs ? trajectories(count) : "frame",
           runs ? "" : plural(count));
    for (int i = 0, named = 0; i < all && named < NAMED; i++) {
        if (runs ? !regression->runs[i].alone[side] : regression->frames[i].pixels != verdict) continue;
        printf(" %s", runs ? regression->runs[i].name : frame_name(&regression->frames[i]));
        named++;
    }
    printf(count > NAMED ? " ...\n" : "\n");
}

/* Pictures that cannot be read, but for the first, which is the error that ends the command. */
static void print_unread(const Regression *regression) {
    enum { SHOWN = 50 };
    int count = 0;
    for (int i = 0; i < regression->count && count < SHOWN; i++)
        if (regression->frames[i].pixels == PIXELS_UNREAD && count++ > 0)
            printf("not comparable: %s\n", regression->frames[i].read_error);
}

static const char *compare_output_differ(int count) { return count == 1 ? "differs" : "differ"; }

/* The three largest regions. */
static void print_regions(const FrameChanges *changes) {
    enum { SHOWN = 3 };
    if (changes == NULL) return;
    int64_t more = changes->regions.count;
    for (int i = 0; i < changes->regions.kept && i < SHOWN; i++, more--)
        printf("  %s\n", region_words(changes, i).text);
    if (more > 0) printf("  and %" PRId64 " more %s\n", more, more == 1 ? "region" : "regions");
}

static void print_flip(const RegressionFrame *frame) {
    if (!isnan(frame->flip)) printf("  FLIP: mean %.3g, 99th percentile %.3g\n", frame->flip, frame->flip_p99);
}

static void print_first(const Regression *regression) {
    for (int i = 0; i < regression->count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        if (frame->alone || (frame->pixels != PIXELS_DIFFER && frame->pixels != PIXELS_RESIZED)) continue;
        printf("first difference: %s: %s\n", frame_name(frame), frame_words(frame).text);
        print_flip(frame);
        print_regions(frame->changes);
        return;
    }
}

/* What the camera explains comes first: with another view, everything else is a consequence. */
static void print_views(const Regression *regression) {
    for (int i = 0; i < regression->cause_count && regression->causes[i].of_view; i++)
        printf("%s\n", cause_words(&regression->causes[i]).text);
}

static void print_causes(const Regression *regression) {
    enum { SHOWN = 8 };
    int shown = 0, more = regression->causes_left_out;
    for (int i = 0; i < regression->cause_count; i++) {
        if (regression->causes[i].of_view) continue;
        if (shown++ < SHOWN)
            printf("%s\n", cause_words(&regression->causes[i]).text);
        else
            more++;
    }
    if (more > 0) printf("and %d more cause%s\n", more, plural(more));
}

static void print_counts(const Regression *regression) {
    const int *by = regression->by_verdict, alone = regression->runs_alone[EXPECTED] + regression->runs_alone[ACTUAL];
    const int runs = regression->run_count - alone, run_failed = regression->run_failed - alone;
    int compared = regression->count - by[PIXELS_MISSING] - by[PIXELS_EXTRA] - by[PIXELS_UNREAD];
    int different = by[PIXELS_DIFFER] + by[PIXELS_RESIZED];
    if (different > 0)
        printf("%d of %d frame%s %s", different, compared, plural(compared), compare_output_differ(different));
    if (different > 0 && run_failed > 0) printf(", ");
    if (run_failed > 0)
        printf("%d of %d %s %s", run_failed, runs, trajectories(runs), compare_output_differ(run_failed));
    if (different > 0 || run_failed > 0) printf("\n");
}

/* Pictures that belong to no sequence: a line each, the worst first. No line begins with a name, which a CI system
   could take for a command. */
static bool print_cases(const Regression *regression, Error *error) {
    enum { SHOWN = 50 };
    const RegressionFrame **failures = regression_failures(regression, error);
    int shown = 0;
    for (int i = 0; failures != NULL && i < regression->failed; i++) {
        if (!failures[i]->alone || failures[i]->pixels >= PIXELS_MISSING) continue;
        if (shown++ == SHOWN) printf("and more; results.json of --report has all\n");
        if (shown > SHOWN) break;
        printf("differs: %s: %s\n", frame_name(failures[i]), case_words(failures[i]).text);
        print_flip(failures[i]);
        if (regression->count == 1) print_regions(failures[i]->changes);
    }
    free(failures);
    return failures != NULL;
}

static bool print_difference(const Regression *regression, Error *error) {
    print_views(regression);
    for (int i = 0; i < 2 * SIDES; i++) print_alone(regression, i % SIDES == 0 ? EXPECTED : ACTUAL, i >= SIDES);
    print_unread(regression);
    print_first(regression);
    if (!print_cases(regression, error)) return false;
    print_causes(regression);
    print_counts(regression);
    RegressionText begin = regression_begin(regression);
    if (begin.text[0] != '\0') printf("%s\n", begin.text);
    printf("verdict: %s\n", regression_verdict(regression).text);
    return true;
}

bool compare_print(const Regression *regression, Error *error) {
    int within = regression->by_verdict[PIXELS_WITHIN], runs = regression->run_count;
    if (!regression_passed(regression)) return print_difference(regression, error);
    printf("%s: %d frame%s", within + regression->run_within > 0 ? "passed" : "equal", regression->count,
           plural(regression->count));
    if (within > 0) printf(", %d of them not equal, but within tolerance", within);
    if (runs > 0) printf(", %d %s", runs, trajectories(runs));
    if (regression->run_within > 0) printf(", %d of them not equal, but within tolerance", regression->run_within);
    printf("\n");
    return true;
}

static void write_pictures(JsonWriter *json, const void *context) { regression_write_json(json, context); }

bool compare_json_pictures(const Regression *regression, Error *error) {
    return json_output("twinbox compare 1", write_pictures, regression, error);
}

/* Looks at the times and sizes of the files: unlike inotify, this also sees changes on network file systems, and needs
   no watch per folder. */

enum { LOOK_EVERY = 250 /* ms */, STILL = 2 /* looks */ };

static bool is_watched(const char *name) {
    const char *ending = strrchr(name, '.');
    return ending != NULL && (strcasecmp(ending, ".png") == 0 || strcasecmp(ending, ".npz") == 0 ||
                              strcmp(name + file_folder_length(name), RULES_NAME) == 0);
}

/* The time of the last change of the inode shows replaced files whose other times were kept. */
static uint64_t hash_file(const char *path, const struct stat *status) {
    const int64_t parts[] = {
        (int64_t)hash_xxh3(path, strlen(path)), (int64_t)status->st_ino,          (int64_t)status->st_size,
        (int64_t)status->st_mtim.tv_sec,        (int64_t)status->st_mtim.tv_nsec, (int64_t)status->st_ctim.tv_sec,
        (int64_t)status->st_ctim.tv_nsec};
    return hash_xxh3(parts, sizeof parts);
}

/* What cannot be listed counts as one state: the comparison tells why, and a change ends that state. */
static uint64_t hash_folder(const char *folder) {
    uint64_t hash = 0;
    FolderList list;
    if (!folder_list(&list, folder, is_watched, true, &(Error){0})) return 0;
    for (size_t i = 0; i < list.count; i++) {
        char path[PATH_MAX];
        struct stat status;
        if (!file_path(path, sizeof path, &(Error){0}, "%s/%s", folder, list.names[i]) || stat(path, &status) != 0)
            continue;
        const uint64_t both[] = {hash, hash_file(path, &status)};
        hash = hash_xxh3(both, sizeof both);
    }
    folder_list_free(&list);
    return hash;
}

static uint64_t hash_inputs(const CompareOptions *options) {
    uint64_t hashes[3] = {0, 0, 0};
    struct stat status;
    if (options->rules != NULL && stat(options->rules, &status) == 0) hashes[2] = hash_file(options->rules, &status);
    for (int i = 0; i < 2; i++) {
        if (stat(options->paths[i], &status) != 0) continue;
        hashes[i] =
            1 + (S_ISDIR(status.st_mode) ? hash_folder(options->paths[i]) : hash_file(options->paths[i], &status));
    }
    return hash_xxh3(hashes, sizeof hashes);
}

/* Returns when the files are no longer those of `before` and have been still; also when interrupted. */
static void wait_for_change(const CompareOptions *options, uint64_t before) {
    const struct timespec pause = {.tv_nsec = LOOK_EVERY * 1000000L};
    uint64_t last = before;
    for (int still = 0; !interrupt_requested() && (last == before || still < STILL);) {
        nanosleep(&pause, NULL);
        uint64_t now = hash_inputs(options);
        still = now == last ? still + 1 : 0;
        last = now;
    }
}

static void print_state(const CompareOptions *options, const Error *error) {
    if (error->kind != ERROR_NONE) fprintf(stderr, "%s\n", error->message);
    fflush(stdout);
    if (note_level() == NOTES_QUIET) return;
    char text[16] = "";
    const time_t now = time(NULL);
    struct tm local;
    if (localtime_r(&now, &local) != NULL) strftime(text, sizeof text, "%H:%M:%S", &local);
    printf("%s: watching %s and %s; Ctrl-C ends\n", text, options->paths[0], options->paths[1]);
    fflush(stdout);
}

bool compare_watch(const CompareOptions *options, CompareRun *compare, Error *error) {
    bool same = false, any = false;
    interrupt_hold();
    while (!interrupt_requested()) {
        /* Before the comparison: a change during it leads to another one. */
        uint64_t before = hash_inputs(options);
        Error now = {0};
        bool equal = compare(options, &now);
        if (any && interrupt_requested() && now.kind != ERROR_NONE) break; /* it did not end */
        same = equal, *error = now, any = true;
        if (interrupt_requested()) break;
        print_state(options, &now);
        wait_for_change(options, before);
    }
    interrupt_release();
    if (error->kind != ERROR_INTERRUPTED) interrupt_forget(); /* a signal is the usual end */
    return same;
}
