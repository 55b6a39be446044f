/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/temporary.h"

#include "common/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { ATTEMPTS = 100 };

const char *temporary_files_folder(void) {
    const char *chosen = getenv("TMPDIR");
    return chosen != NULL && chosen[0] != '\0' ? chosen : "/tmp";
}

static bool print_name(TemporaryFile *temporary, const char *path, unsigned attempt) {
    struct timespec now;
    char owner[TEMPORARY_OWNER];
    clock_gettime(CLOCK_REALTIME, &now);
    temporary_owner(owner);
    const int length = snprintf(temporary->name, sizeof temporary->name, "%.*s.twinbox-%s%lx-%u.tmp",
                                (int)file_folder_length(path), path, owner, (unsigned long)now.tv_nsec, attempt);
    if (length >= 0 && (size_t)length < sizeof temporary->name) return true;
    errno = ENAMETOOLONG;
    return false;
}

bool temporary_lock(int file) {
    struct stat status;
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    return fstat(file, &status) != 0 || status.st_nlink > 0;
}

/* Not mkstemp: its files are readable by their owner only, whatever the umask. */
static bool open_named(TemporaryFile *temporary, const char *path) {
    for (unsigned attempt = 0; attempt <= ATTEMPTS && print_name(temporary, path, attempt); attempt++) {
        temporary->file = openat(temporary->at, temporary->name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (temporary->file >= 0 && temporary_lock(temporary->file)) return true;
        if (temporary->file < 0 && errno != EEXIST) break;
        if (temporary->file >= 0) temporary_close(temporary);
    }
    temporary->name[0] = '\0';
    return false;
}

/* A file without a name gets one through /proc. */
static int open_nameless(int at, const char *path) {
    char folder[PATH_MAX];
    const int length = (int)file_folder_length(path);
    if (access("/proc/self/fd", X_OK) != 0) {
        errno = EOPNOTSUPP;
        return -1;
    }
    if (snprintf(folder, sizeof folder, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >= PATH_MAX) {
        errno = ENAMETOOLONG;
        return -1;
    }
    return openat(at, folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
}

bool temporary_open(TemporaryFile *temporary, int at, const char *path) {
    temporary->at = at;
    temporary->name[0] = '\0';
    temporary->file = open_nameless(at, path);
    if (temporary->file >= 0) return true;
    return (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL) && open_named(temporary, path);
}

int temporary_nameless(const char *path) {
    TemporaryFile temporary;
    temporary_sweep(AT_FDCWD, path);
    if (!temporary_open(&temporary, AT_FDCWD, path)) return -1;
    if (temporary_remove_name(&temporary)) return temporary.file;
    temporary_close(&temporary);
    return -1;
}

static bool link_to(const TemporaryFile *temporary, const char *path) {
    char descriptor[64];
    if (temporary->name[0] != '\0') return linkat(temporary->at, temporary->name, temporary->at, path, 0) == 0;
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", temporary->file);
    return linkat(AT_FDCWD, descriptor, temporary->at, path, AT_SYMLINK_FOLLOW) == 0;
}

/* Locked before it has the name. */
static bool give_name(TemporaryFile *temporary, const char *path) {
    flock(temporary->file, LOCK_EX | LOCK_NB);
    TemporaryFile named = *temporary;
    for (unsigned attempt = 0; attempt <= ATTEMPTS && print_name(&named, path, attempt); attempt++) {
        if (link_to(temporary, named.name)) {
            *temporary = named;
            return true;
        }
        if (errno != EEXIST) return false;
    }
    return false;
}

bool temporary_rename(TemporaryFile *temporary, const char *path) {
    if (temporary->name[0] == '\0') {
        /* A link, unlike a rename, needs no other name before, but cannot replace a file. */
        if (link_to(temporary, path)) return true;
        if (errno != EEXIST || !give_name(temporary, path)) return false;
    }
    if (renameat(temporary->at, temporary->name, temporary->at, path) != 0) return false;
    temporary->name[0] = '\0';
    return true;
}

bool temporary_link(TemporaryFile *temporary, const char *path) { return link_to(temporary, path); }

bool temporary_remove_name(TemporaryFile *temporary) {
    const bool done = temporary->name[0] == '\0' || unlinkat(temporary->at, temporary->name, 0) == 0;
    temporary->name[0] = '\0';
    return done;
}

void temporary_close(TemporaryFile *temporary) {
    const int cause = errno;
    temporary_remove_name(temporary);
    if (temporary->file >= 0) close(temporary->file);
    temporary->file = -1;
    errno = cause;
}
