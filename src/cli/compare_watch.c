/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks at the times and sizes of the files: unlike inotify, this also sees changes on network file systems, and needs
   no watch per folder. */
#include "cli/compare_watch.h"

#include "cli/interrupt.h"
#include "cli/notes.h"
#include "common/file.h"
#include "common/folder.h"
#include "common/hash.h"
#include "regression/rules.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>

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
