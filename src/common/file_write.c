/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files out. */
#include "common/file.h"

#include "common/standard_io.h"
#include "common/trace.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* What a file is to hold: a block of memory, or all of an open file. */
typedef struct Contents {
    const char *data;
    size_t size;
    int draft; /* -1: the block */
} Contents;

static bool write_all(int file, const char *data, size_t size) {
    while (size > 0) {
        ssize_t written = write(file, data, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        data += written;
        size -= (size_t)written;
    }
    return true;
}

bool file_copy(int to, int from) {
    enum { BLOCK = 1 << 17 };
    char *block = malloc(BLOCK);
    bool done = block != NULL;
    off_t at = 0;
    while (done) {
        ssize_t got = pread(from, block, BLOCK, at);
        if (got < 0 && errno == EINTR) continue;
        if (got == 0) break;
        done = got > 0 && write_all(to, block, (size_t)got);
        if (done) at += got;
    }
    int cause = errno;
    free(block);
    errno = cause;
    return done;
}

static bool write_contents(int file, const Contents *contents) {
    return contents->draft >= 0 ? file_copy(file, contents->draft) : write_all(file, contents->data, contents->size);
}

static bool temporary_name(const char *path, unsigned attempt, char *name, size_t size) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    int length = snprintf(name, size, "%.*s.twinbox-%ld-%lx-%u.tmp", (int)file_folder_length(path), path,
                          (long)getpid(), (unsigned long)now.tv_nsec, attempt);
    if (length >= 0 && (size_t)length < size) return true;
    errno = ENAMETOOLONG;
    return false;
}

enum { ATTEMPTS = 100 };

/* Creates a file in the folder of path (relative to the directory `at`) and returns its name in `name`. Not mkstemp:
   its files are readable by their owner only, whatever the umask. */
static int create_beside(int at, const char *path, int how, char *name, size_t name_size) {
    for (unsigned attempt = 0;; attempt++) {
        if (!temporary_name(path, attempt, name, name_size)) return -1;
        int file = openat(at, name, how | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST || attempt == ATTEMPTS) return file;
    }
}

/* Gives a draft a name in the folder of path; false if its file system cannot. */
static bool name_draft(int draft, const char *path, char *name, size_t name_size) {
    char descriptor[64];
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", draft);
    for (unsigned attempt = 0; attempt <= ATTEMPTS; attempt++) {
        if (!temporary_name(path, attempt, name, name_size)) return false;
        if (linkat(AT_FDCWD, descriptor, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0) return true;
        if (errno != EEXIST) return false;
    }
    return false;
}

/* An entry that cannot be opened or does not support fsync counts as synced. */
static bool sync_entry(const char *path) {
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return true;
    bool done = fsync(file) == 0 || errno == EINVAL;
    int cause = errno;
    close(file);
    errno = cause;
    return done;
}

/* Also the directory entry must survive a power cut. */
static bool sync_folder(int at, const char *path) {
    char folder[PATH_MAX];
    if (at != AT_FDCWD) return fsync(at) == 0 || errno == EINVAL;
    int length = (int)file_folder_length(path);
    snprintf(folder, sizeof folder, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".");
    return sync_entry(folder);
}

/* Closes also after a failure, and keeps errno of the first failure. */
static bool close_after(int file, bool done) {
    int cause = errno;
    if (close(file) != 0 && done) return false;
    errno = cause;
    return done;
}

/* Writes a file with the name `name` beside path, as a whole or not at all. */
static bool write_beside(int at, const char *path, const Contents *contents, bool wait, char *name, size_t name_size) {
    if (contents->draft >= 0 && at == AT_FDCWD && fsync(contents->draft) == 0 &&
        name_draft(contents->draft, path, name, name_size))
        return true;
    int file = create_beside(at, path, O_WRONLY, name, name_size);
    if (file < 0) return false;
    if (close_after(file, write_contents(file, contents) && (!wait || fsync(file) == 0))) return true;
    int cause = errno;
    unlinkat(at, name, 0);
    errno = cause;
    return false;
}

static bool replace(int at, const char *path, const Contents *contents, bool wait) {
    char name[PATH_MAX];
    if (!write_beside(at, path, contents, wait, name, sizeof name)) return false;
    if (renameat(at, name, at, path) == 0) return !wait || sync_folder(at, path);
    int cause = errno;
    unlinkat(at, name, 0);
    errno = cause;
    return false;
}

static bool is_standard_output(const struct stat *status) {
    struct stat output;
    return fstat(STDOUT_FILENO, &output) == 0 && output.st_dev == status->st_dev && output.st_ino == status->st_ino;
}

/* For devices, pipes and the target of /dev/stdout. */
static bool write_into(int file, const Contents *contents) {
    return file >= 0 && close_after(file, write_contents(file, contents));
}

static bool put(const char *path, const Contents *contents, bool wait) {
    struct stat status;
    if (path_is_standard(path)) return write_into(dup(standard_output()), contents);
    if (lstat(path, &status) != 0) return replace(AT_FDCWD, path, contents, wait);
    bool is_link = S_ISLNK(status.st_mode);
    if (is_link && stat(path, &status) != 0) return false;
    if (is_standard_output(&status)) return write_into(dup(STDOUT_FILENO), contents);
    if (!S_ISREG(status.st_mode)) return write_into(open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC), contents);
    if (!is_link) return replace(AT_FDCWD, path, contents, wait);
    char target[PATH_MAX];
    return realpath(path, target) != NULL && replace(AT_FDCWD, target, contents, wait);
}

static bool finish(bool written, const char *path, size_t size, Error *error) {
    if (!written) return error_system(error, path, "cannot write: %s", strerror(errno));
    trace_line("wrote %s, %zu bytes", path, size);
    return true;
}

bool file_append(const char *path, const void *data, size_t size, Error *error) {
    const int file = open(path, O_WRONLY | O_APPEND | O_CREAT | O_NOCTTY | O_CLOEXEC, 0666);
    return finish(write_into(file, &(Contents){data, size, -1}), path, size, error);
}

bool file_write(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, &(Contents){data, size, -1}, true), path, size, error);
}

bool file_create(const char *path, const void *data, size_t size, Error *error) {
    char name[PATH_MAX];
    if (!write_beside(AT_FDCWD, path, &(Contents){data, size, -1}, true, name, sizeof name))
        return finish(false, path, size, error);
    /* A link, unlike a renamed file, does not replace what is there. */
    const bool done = link(name, path) == 0;
    const int cause = errno;
    unlink(name);
    errno = cause;
    if (!done && errno == EEXIST) return error_input(error, path, "exists already, and is not overwritten");
    return finish(done && sync_folder(AT_FDCWD, path), path, size, error);
}

bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error) {
    return finish(replace(folder, name, &(Contents){data, size, -1}, true), path, size, error);
}

bool file_write_soon(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, &(Contents){data, size, -1}, false), path, size, error);
}

bool file_sync(const char *path, Error *error) {
    return sync_entry(path) || error_system(error, path, "cannot write: %s", strerror(errno));
}

/* The folder where a draft of `path` can become that file; for pipes and devices the one for temporary files. */
static bool draft_folder(const char *path, char folder[PATH_MAX]) {
    struct stat status;
    const char *temporary = getenv("TMPDIR");
    char target[PATH_MAX];
    if (path_is_standard(path) ||
        (stat(path, &status) == 0 && (!S_ISREG(status.st_mode) || is_standard_output(&status))))
        return snprintf(folder, PATH_MAX, "%s", temporary != NULL && temporary[0] != '\0' ? temporary : "/tmp") <
               PATH_MAX;
    if (realpath(path, target) == NULL && snprintf(target, sizeof target, "%s", path) >= PATH_MAX) return false;
    int length = (int)file_folder_length(target);
    return snprintf(folder, PATH_MAX, "%.*s", length > 0 ? length : 1, length > 0 ? target : ".") < PATH_MAX;
}

/* Where the file system has no files without a name: one whose name is removed at once. */
static int open_and_unlink(const char *folder) {
    char inside[PATH_MAX], name[PATH_MAX];
    if (snprintf(inside, sizeof inside, "%s/x", folder) >= PATH_MAX) return -1;
    int file = create_beside(AT_FDCWD, inside, O_RDWR, name, sizeof name);
    if (file >= 0) unlink(name);
    return file;
}

int file_draft(const char *path, Error *error) {
    char folder[PATH_MAX];
    if (!draft_folder(path, folder)) {
        error_system(error, path, "cannot write: %s", strerror(ENAMETOOLONG));
        return -1;
    }
    int draft = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (draft < 0 && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) draft = open_and_unlink(folder);
    if (draft < 0) error_system(error, path, "cannot write: %s", strerror(errno));
    return draft;
}

bool file_draft_write(int draft, const char *path, const void *data, size_t size, Error *error) {
    return write_all(draft, data, size) || error_system(error, path, "cannot write: %s", strerror(errno));
}

bool file_draft_publish(int draft, const char *path, Error *error) {
    const off_t size = lseek(draft, 0, SEEK_END);
    return finish(put(path, &(Contents){.draft = draft}, true), path, (size_t)size, error);
}
