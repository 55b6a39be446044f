/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files in and out. */
#include "common/file.h"

#include "common/array.h"
#include "common/trace.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

bool file_open_error(const char *path, Error *error) {
    int cause = errno;
    bool machine = cause == EMFILE || cause == ENFILE || cause == ENOMEM || cause == EIO;
    return machine ? error_system(error, path, "cannot open: %s", strerror(cause))
                   : error_input(error, path, "cannot open: %s", strerror(cause));
}

/* Reads to the end, not to the size that stat returns: the file may be growing. */
static char *read_all(int file, const char *path, size_t limit, size_t expected, size_t *size, Error *error) {
    void *data = NULL;
    size_t capacity = 0, used = 0, wanted = expected + 2;
    for (;;) {
        if (!array_reserve(&data, &capacity, wanted, 1)) {
            error_memory(error, path);
            break;
        }
        ssize_t got = read(file, (char *)data + used, capacity - used - 1);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            error_system(error, path, "cannot read: %s", strerror(errno));
            break;
        }
        used += (size_t)got;
        if (used > limit) {
            error_input(error, path, "larger than %zu bytes", limit);
            break;
        }
        if (got == 0) {
            ((char *)data)[used] = '\0';
            *size = used;
            return data;
        }
        wanted = used + 2;
    }
    free(data);
    return NULL;
}

/* Without O_NONBLOCK, opening a FIFO waits for a writer. */
enum { OPEN_TO_READ = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC };

static char *read_and_close(int file, const char *path, size_t limit, size_t *size, Error *error) {
    if (file < 0) {
        file_open_error(path, error);
        return NULL;
    }
    char *data = NULL;
    struct stat status;
    if (fstat(file, &status) != 0)
        error_system(error, path, "cannot read: %s", strerror(errno));
    else if (!S_ISREG(status.st_mode))
        error_input(error, path, "not a regular file");
    else if ((uintmax_t)status.st_size > limit)
        error_input(error, path, "larger than %zu bytes", limit);
    else
        data = read_all(file, path, limit, (size_t)status.st_size, size, error);
    close(file);
    if (data != NULL) trace_line("read %s, %zu bytes", path, *size);
    return data;
}

char *file_read(const char *path, size_t limit, size_t *size, Error *error) {
    return read_and_close(open(path, OPEN_TO_READ), path, limit, size, error);
}

char *file_read_at(int folder, const char *name, const char *path, size_t limit, size_t *size, Error *error) {
    return read_and_close(openat(folder, name, OPEN_TO_READ | O_NOFOLLOW), path, limit, size, error);
}

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

/* Creates a file in the folder of path (relative to the directory `at`) and returns its name in `name`. Not mkstemp:
   its files are readable by their owner only, whatever the umask. */
static int create_beside(int at, const char *path, char *name, size_t name_size) {
    for (unsigned attempt = 0;; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        int length = snprintf(name, name_size, "%.*s.twinbox-%ld-%lx-%u.tmp", (int)file_folder_length(path), path,
                              (long)getpid(), (unsigned long)now.tv_nsec, attempt);
        if (length < 0 || (size_t)length >= name_size) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int file = openat(at, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST || attempt == 100) return file;
    }
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

static bool replace(int at, const char *path, const void *data, size_t size, bool wait) {
    char name[PATH_MAX];
    int file = create_beside(at, path, name, sizeof name);
    if (file < 0) return false;
    bool done = close_after(file, write_all(file, data, size) && (!wait || fsync(file) == 0));
    if (done && renameat(at, name, at, path) == 0) return !wait || sync_folder(at, path);
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
static bool write_into(int file, const void *data, size_t size) {
    return file >= 0 && close_after(file, write_all(file, data, size));
}

static bool put(const char *path, const void *data, size_t size, bool wait) {
    struct stat status;
    if (lstat(path, &status) != 0) return replace(AT_FDCWD, path, data, size, wait);
    bool is_link = S_ISLNK(status.st_mode);
    if (is_link && stat(path, &status) != 0) return false;
    if (is_standard_output(&status)) return write_into(dup(STDOUT_FILENO), data, size);
    if (!S_ISREG(status.st_mode)) return write_into(open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC), data, size);
    if (!is_link) return replace(AT_FDCWD, path, data, size, wait);
    char target[PATH_MAX];
    return realpath(path, target) != NULL && replace(AT_FDCWD, target, data, size, wait);
}

static bool finish(bool written, const char *path, size_t size, Error *error) {
    if (!written) return error_system(error, path, "cannot write: %s", strerror(errno));
    trace_line("wrote %s, %zu bytes", path, size);
    return true;
}

bool file_append(const char *path, const void *data, size_t size, Error *error) {
    const int file = open(path, O_WRONLY | O_APPEND | O_CREAT | O_NOCTTY | O_CLOEXEC, 0666);
    return finish(write_into(file, data, size), path, size, error);
}

bool file_write(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, data, size, true), path, size, error);
}

bool file_create(const char *path, const void *data, size_t size, Error *error) {
    char name[PATH_MAX];
    int file = create_beside(AT_FDCWD, path, name, sizeof name);
    if (file < 0) return finish(false, path, size, error);
    /* A link, unlike a renamed file, does not replace what is there. */
    bool done = close_after(file, write_all(file, data, size) && fsync(file) == 0) && link(name, path) == 0;
    int cause = errno;
    unlink(name);
    errno = cause;
    if (!done && errno == EEXIST) return error_input(error, path, "exists already, and is not overwritten");
    return finish(done && sync_folder(AT_FDCWD, path), path, size, error);
}

bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error) {
    return finish(replace(folder, name, data, size, true), path, size, error);
}

bool file_write_soon(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, data, size, false), path, size, error);
}

bool file_sync(const char *path, Error *error) {
    return sync_entry(path) || error_system(error, path, "cannot write: %s", strerror(errno));
}

static bool is_directory(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

bool file_make_directory(const char *path, Error *error) {
    char part[PATH_MAX];
    size_t length = strlen(path);
    if (length == 0 || length >= sizeof part)
        return error_system(error, path, "cannot make the directory: %s",
                            strerror(length == 0 ? ENOENT : ENAMETOOLONG));
    for (size_t end = 1; end <= length; end++) {
        if (path[end] != '/' && path[end] != '\0') continue;
        snprintf(part, sizeof part, "%.*s", (int)end, path);
        if (mkdir(part, 0777) == 0 || is_directory(part)) continue;
        /* is_directory() has overwritten errno; a second mkdir() restores it. */
        mkdir(part, 0777);
        return error_system(error, part, "cannot make the directory: %s", strerror(errno));
    }
    return true;
}

bool file_path(char *path, size_t size, Error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(path, size, format, arguments);
    va_end(arguments);
    return (length >= 0 && (size_t)length < size) ||
           error_input(error, "path", "%.200s... is longer than %zu bytes", path, size - 1);
}

size_t file_folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash == NULL ? 0 : (size_t)(slash - path) + 1;
}

void file_name_clean(char *name) {
    for (char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && strchr("-_.=", *c) == NULL) *c = '_';
    if (name[0] == '.') name[0] = '_';
}
