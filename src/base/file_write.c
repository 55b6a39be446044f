/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes whole files: beside the name, then fsync and rename, or as a draft that is written piece by piece. */
#include "base/base.h"
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a file is to hold: a block of memory, or all of an open file. */
typedef struct Contents {
    const char *data;
    size_t size;
    int draft; /* -1: the block */
} Contents;

bool file_write_all(int file, const void *data, size_t size) {
    const char *bytes = data;
    while (size > 0) {
        ssize_t written = write(file, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes += written;
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
        done = got > 0 && file_write_all(to, block, (size_t)got);
        if (done) at += got;
    }
    int cause = errno;
    free(block);
    errno = cause;
    return done;
}

static bool write_contents(int file, const Contents *contents) {
    return contents->draft >= 0 ? file_copy(file, contents->draft)
                                : file_write_all(file, contents->data, contents->size);
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

/* What close() would report, while the lock lasts. */
static bool file_write_flush(int file, bool wait) {
    if (wait && fsync(file) != 0) return false;
    const int copy = dup(file);
    return copy >= 0 && close(copy) == 0;
}

/* A draft need not be copied where it can get the name itself. */
static bool place_draft(int draft, const char *path) {
    TemporaryFile whole = {.at = AT_FDCWD, .file = draft};
    const bool done = temporary_rename(&whole, path);
    temporary_remove_name(&whole);
    return done;
}

static bool place_new(int at, const char *path, const Contents *contents, bool wait,
                      bool (*place)(TemporaryFile *, const char *)) {
    TemporaryFile new;
    temporary_sweep(at, path);
    if (!temporary_open(&new, at, path)) return false;
    const bool done = write_contents(new.file, contents) && file_write_flush(new.file, wait) && place(&new, path);
    temporary_close(&new);
    return done;
}

static bool file_write_replace(int at, const char *path, const Contents *contents, bool wait) {
    if (contents->draft >= 0 && at == AT_FDCWD) {
        if (!file_write_flush(contents->draft, wait)) return false;
        temporary_sweep(at, path);
        if (place_draft(contents->draft, path)) return !wait || sync_folder(at, path);
    }
    return place_new(at, path, contents, wait, temporary_rename) && (!wait || sync_folder(at, path));
}

bool standard_output_is(const struct stat *status) {
    struct stat output;
    return fstat(STDOUT_FILENO, &output) == 0 && output.st_dev == status->st_dev && output.st_ino == status->st_ino;
}

/* For devices, pipes and the target of /dev/stdout. */
static bool write_into(int file, const Contents *contents) {
    return file >= 0 && close_after(file, write_contents(file, contents));
}

static bool file_write_put(const char *path, const Contents *contents, bool wait) {
    struct stat status;
    if (path_is_standard(path)) return write_into(dup(standard_output()), contents);
    if (lstat(path, &status) != 0) return errno == ENOENT && file_write_replace(AT_FDCWD, path, contents, wait);
    bool is_link = S_ISLNK(status.st_mode);
    if (is_link && stat(path, &status) != 0) return false;
    if (standard_output_is(&status)) return write_into(dup(STDOUT_FILENO), contents);
    if (!S_ISREG(status.st_mode)) return write_into(open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC), contents);
    if (!is_link) return file_write_replace(AT_FDCWD, path, contents, wait);
    char target[PATH_MAX];
    return realpath(path, target) != NULL && file_write_replace(AT_FDCWD, target, contents, wait);
}

static bool file_write_finish(bool written, const char *path, size_t size, Error *error) {
    if (!written) return error_system(error, path, "cannot write: %s", file_make_cause(path, errno));
    trace_line("wrote %s, %zu bytes", path, size);
    return true;
}

bool file_append(const char *path, const void *data, size_t size, Error *error) {
    const int file = open(path, O_WRONLY | O_APPEND | O_CREAT | O_NOCTTY | O_CLOEXEC, 0666);
    return file_write_finish(write_into(file, &(Contents){data, size, -1}), path, size, error);
}

bool file_write(const char *path, const void *data, size_t size, Error *error) {
    return file_write_finish(file_write_put(path, &(Contents){data, size, -1}, true), path, size, error);
}

bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error) {
    size_t size;
    char *text = file_print(print, context, &size);
    bool done = text != NULL ? file_write(path, text, size, error) : error_memory(error, path);
    free(text);
    return done;
}

bool file_create(const char *path, const void *data, size_t size, Error *error) {
    const bool done = place_new(AT_FDCWD, path, &(Contents){data, size, -1}, true, temporary_link);
    if (!done && errno == EEXIST) return error_input(error, path, "exists already, and is not overwritten");
    return file_write_finish(done && sync_folder(AT_FDCWD, path), path, size, error);
}

bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error) {
    return file_write_finish(file_write_replace(folder, name, &(Contents){data, size, -1}, true), path, size, error);
}

bool file_write_soon(const char *path, const void *data, size_t size, Error *error) {
    return file_write_finish(file_write_put(path, &(Contents){data, size, -1}, false), path, size, error);
}

bool file_remove(const char *path, Error *error) {
    return unlink(path) == 0 || errno == ENOENT || error_system(error, path, "cannot be removed: %s", strerror(errno));
}

bool file_sync(const char *path, Error *error) {
    return sync_entry(path) || error_system(error, path, "cannot write: %s", strerror(errno));
}

/* A path in the folder where a draft of `path` can become that file; for pipes and devices in that for temporary
   files. */
static bool draft_place(const char *path, char place[PATH_MAX]) {
    struct stat status;
    if (path_is_standard(path) ||
        (stat(path, &status) == 0 && (!S_ISREG(status.st_mode) || standard_output_is(&status))))
        return snprintf(place, PATH_MAX, "%s/draft", temporary_files_folder()) < PATH_MAX;
    return realpath(path, place) != NULL || snprintf(place, PATH_MAX, "%s", path) < PATH_MAX;
}

int file_draft(const char *path, Error *error) {
    char place[PATH_MAX];
    errno = ENAMETOOLONG;
    const int draft = draft_place(path, place) ? temporary_nameless(place) : -1;
    if (draft < 0) error_system(error, place, "cannot write: %s", file_make_cause(place, errno));
    return draft;
}

bool file_draft_write(int draft, const char *path, const void *data, size_t size, Error *error) {
    return file_write_all(draft, data, size) || error_system(error, path, "cannot write: %s", strerror(errno));
}

bool file_draft_publish(int draft, const char *path, Error *error) {
    const off_t size = lseek(draft, 0, SEEK_END);
    return file_write_finish(file_write_put(path, &(Contents){.draft = draft}, true), path, (size_t)size, error);
}
