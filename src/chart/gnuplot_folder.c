/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/gnuplot_folder.h"

#include "common/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define START "twinbox-plot-"

enum { ATTEMPTS = 10 };

/* Has no folders in it. */
static void remove_files(int folder) {
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *entries = copy >= 0 ? fdopendir(copy) : NULL;
    if (entries == NULL) {
        if (copy >= 0) close(copy);
        return;
    }
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) unlinkat(folder, entry->d_name, 0);
    closedir(entries);
}

/* Again while it is not empty: a gnuplot whose twinbox was killed may still begin the files of its script. */
static bool remove_whole(int at, const char *path, int folder) {
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        remove_files(folder);
        if (unlinkat(at, path, AT_REMOVEDIR) == 0) return true;
        if (errno != ENOTEMPTY && errno != EEXIST) return false;
    }
    return false;
}

static void remove_dead(int at, const char *name) {
    struct stat status;
    const int folder = openat(at, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    if (fstat(folder, &status) == 0 && status.st_uid == geteuid() && temporary_lock(folder))
        remove_whole(at, name, folder);
    close(folder);
}

static void sweep(const char *path) {
    DIR *entries = opendir(path);
    if (entries == NULL) return;
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;)
        if (strncmp(entry->d_name, START, sizeof START - 1) == 0 &&
            temporary_owner_ended(entry->d_name + sizeof START - 1))
            remove_dead(dirfd(entries), entry->d_name);
    closedir(entries);
}

static bool is_still_there(const GnuplotFolder *folder) {
    struct stat named, opened;
    return stat(folder->path, &named) == 0 && fstat(folder->lock, &opened) == 0 && named.st_dev == opened.st_dev &&
           named.st_ino == opened.st_ino;
}

/* Between mkdtemp() and the lock, another process may remove it. */
static bool make(GnuplotFolder *folder, const char *place) {
    char owner[TEMPORARY_OWNER];
    temporary_owner(owner);
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (snprintf(folder->path, sizeof folder->path, "%s/" START "%sXXXXXX", place, owner) >=
            (int)sizeof folder->path) {
            errno = ENAMETOOLONG;
            return false;
        }
        if (mkdtemp(folder->path) == NULL) return false;
        folder->lock = open(folder->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder->lock >= 0 && temporary_lock(folder->lock) && is_still_there(folder)) return true;
        const int cause = errno;
        if (folder->lock >= 0) close(folder->lock);
        rmdir(folder->path);
        errno = cause;
        if (folder->lock < 0 && errno != ENOENT) return false;
    }
    return false;
}

bool gnuplot_folder_make(GnuplotFolder *folder, Error *error) {
    char place[PATH_MAX];
    const char *wanted = temporary_files_folder();
    if (realpath(wanted, place) == NULL)
        return error_system(error, wanted, "cannot be used for temporary files: %s", strerror(errno));
    sweep(place);
    return make(folder, place) ||
           error_system(error, wanted, "cannot be used for temporary files: %s", strerror(errno));
}

bool gnuplot_folder_remove(GnuplotFolder *folder, Error *error) {
    const bool done = remove_whole(AT_FDCWD, folder->path, folder->lock) ||
                      error_system(error, folder->path, "cannot be removed: %s", strerror(errno));
    close(folder->lock);
    return done;
}
