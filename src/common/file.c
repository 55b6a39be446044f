/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files in. */
#include "common/file.h"

#include "common/array.h"
#include "common/cause.h"
#include "common/standard_io.h"
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
#include <unistd.h>

bool file_open_error(const char *path, Error *error) {
    int cause = errno;
    return cause_is_system(cause) ? error_system(error, path, "cannot open: %s", strerror(cause))
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
    if (path_is_standard(path)) {
        const int input = standard_input_open(error);
        return input >= 0 ? read_and_close(input, path, limit, size, error) : NULL;
    }
    return read_and_close(open(path, OPEN_TO_READ), path, limit, size, error);
}

char *file_read_at(int folder, const char *name, const char *path, size_t limit, size_t *size, Error *error) {
    return read_and_close(openat(folder, name, OPEN_TO_READ | O_NOFOLLOW), path, limit, size, error);
}

char *file_read_input(size_t limit, size_t *size, Error *error) {
    static const char name[] = "standard input";
    char *data = NULL;
    size_t capacity = 0;
    ssize_t count = 1;
    *size = 0;
    while (count > 0 && *size <= limit) {
        void *items = data;
        bool room = array_reserve(&items, &capacity, *size + (1 << 16) + 1, 1);
        data = items;
        if (!room) {
            error_memory(error, name);
            free(data);
            return NULL;
        }
        do count = read(STDIN_FILENO, data + *size, 1 << 16);
        while (count < 0 && errno == EINTR);
        if (count > 0) *size += (size_t)count;
    }
    bool ok = count == 0 || (count < 0 ? error_system(error, name, "cannot read: %s", strerror(errno))
                                       : error_input(error, name, "larger than %zu bytes", limit));
    if (ok) {
        data[*size] = '\0';
        return data;
    }
    free(data);
    return NULL;
}

ssize_t file_read_all(int file, void *data, size_t size) {
    size_t used = 0;
    while (used < size) {
        const ssize_t got = read(file, (char *)data + used, size - used);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        used += (size_t)got;
    }
    return (ssize_t)used;
}

bool file_find(const char *path, bool *there, Error *error) {
    struct stat status;
    *there = stat(path, &status) == 0;
    return *there || errno == ENOENT || errno == ENOTDIR ||
           error_system(error, path, "cannot be read: %s", strerror(errno));
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
        if (mkdir(part, 0777) == 0) continue;
        const int cause = errno;
        if (!is_directory(part)) return error_system(error, part, "cannot make the directory: %s", strerror(cause));
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

bool file_name_ends_with(const char *name, const char *ending) {
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && strcmp(name + length - tail, ending) == 0;
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
