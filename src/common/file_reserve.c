/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/file_reserve.h"

#include "common/file.h"
#include "common/hash.h"
#include "common/lock.h"
#include "common/standard_io.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* OpenMP calls exit() when it gets no memory or no thread. */
static TemporaryFile *held;

static void remove_held(void) {
    if (held != NULL) temporary_remove_name(held);
}

/* False if the process that had the file removed its name while this one waited. */
static bool has_name(const TemporaryFile *lock) {
    struct stat opened, named;
    return fstat(lock->file, &opened) == 0 && stat(lock->name, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

static bool take(TemporaryFile *lock, const char *path, Error *error) {
    do {
        if (lock->file >= 0) close(lock->file);
        lock->file = open(lock->name, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (lock->file < 0) return error_system(error, path, "cannot be locked: %s", strerror(errno));
        if (!lock_take(lock->file, path, "is making this file", error)) return false;
    } while (!has_name(lock));
    return true;
}

bool file_reserve(FileReservation *reservation, const char *path, Error *error) {
    TemporaryFile *lock = &reservation->lock;
    const size_t folder = file_folder_length(path);
    struct stat status;
    *lock = (TemporaryFile){.at = AT_FDCWD, .file = -1};
    if (path_is_standard(path) || (stat(path, &status) == 0 && !S_ISREG(status.st_mode))) return true;
    if (!file_path(lock->name, sizeof lock->name, error, "%.*s.twinbox-%016" PRIx64 ".tmp", (int)folder, path,
                   hash_xxh3(path + folder, strlen(path + folder))))
        return false;
    if (!take(lock, path, error)) {
        if (lock->file >= 0) close(lock->file);
        return false;
    }
    if (held == NULL) atexit(remove_held);
    held = lock;
    return true;
}

bool file_release(FileReservation *reservation, Error *error) {
    char name[PATH_MAX];
    held = NULL;
    strcpy(name, reservation->lock.name);
    const bool done = temporary_remove_name(&reservation->lock) ||
                      error_system(error, name, "cannot be removed: %s", strerror(errno));
    temporary_close(&reservation->lock);
    return done;
}
