/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads files, standard input and folders; paths; and what is printed on standard output while a file is written to
   it. */
#include "base/file.h"

#include "base/base.h"

#include <dirent.h>
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

static int copy_of_input = -1, reserved_output = -1;

/* Readers accept no larger file. */
static const uint64_t MOST = (UINT64_C(1) << 31) + 1;

static bool copy_input(int copy, Error *error) {
    char block[1 << 16];
    for (uint64_t size = 0;;) {
        ssize_t got = read(STDIN_FILENO, block, sizeof block);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return error_system(error, "-", "cannot read standard input: %s", strerror(errno));
        if (got == 0) return true;
        size += (uint64_t)got;
        if (size > MOST) return error_input(error, "-", "larger than 2 GiB");
        if (!file_draft_write(copy, "-", block, (size_t)got, error)) return false;
    }
}

int standard_input_open(Error *error) {
    if (copy_of_input < 0) {
        int copy = file_draft("-", error);
        if (copy >= 0 && !copy_input(copy, error)) {
            close(copy);
            copy = -1;
        }
        if (copy < 0) return -1;
        copy_of_input = copy;
    }
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", copy_of_input);
    const int input = open(path, O_RDONLY | O_CLOEXEC);
    if (input < 0) error_system(error, "-", "cannot read standard input again: %s", strerror(errno));
    return input;
}

bool standard_input_is_zip(void) {
    Error ignored = {0};
    char start[2];
    const int input = standard_input_open(&ignored);
    const bool is_zip = input >= 0 && read(input, start, sizeof start) == sizeof start && memcmp(start, "PK", 2) == 0;
    if (input >= 0) close(input);
    return is_zip;
}

bool standard_output_reserve(Error *error) {
    if (reserved_output >= 0) return error_input(error, "-", "only one file can be written to standard output");
    fflush(stdout);
    reserved_output = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    return (reserved_output >= 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0) ||
           error_system(error, "-", "cannot write to standard output: %s", strerror(errno));
}

bool standard_output_is_reserved(void) { return reserved_output >= 0; }

int standard_output(void) { return reserved_output >= 0 ? reserved_output : STDOUT_FILENO; }

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

/* Closes what cannot be read. */
static int check_open(int file, const char *path, size_t limit, size_t *size, Error *error) {
    struct stat status;
    if (file < 0) return file_open_error(path, error), -1;
    if (fstat(file, &status) != 0)
        error_system(error, path, "cannot read: %s", strerror(errno));
    else if (!S_ISREG(status.st_mode))
        error_input(error, path, "not a regular file");
    else if ((uintmax_t)status.st_size > limit)
        error_input(error, path, "larger than %zu bytes", limit);
    else
        return *size = (size_t)status.st_size, file;
    close(file);
    return -1;
}

int file_open(const char *path, size_t limit, size_t *size, Error *error) {
    const bool standard = path_is_standard(path);
    const int file = standard ? standard_input_open(error) : open(path, OPEN_TO_READ);
    return standard && file < 0 ? -1 : check_open(file, path, limit, size, error);
}

static char *read_and_close(int file, const char *path, size_t limit, size_t *size, Error *error) {
    char *data = file < 0 ? NULL : read_all(file, path, limit, *size, size, error);
    if (file >= 0) close(file);
    if (data != NULL) trace_line("read %s, %zu bytes", path, *size);
    return data;
}

char *file_read(const char *path, size_t limit, size_t *size, Error *error) {
    return read_and_close(file_open(path, limit, size, error), path, limit, size, error);
}

char *file_read_at(int folder, const char *name, const char *path, size_t limit, size_t *size, Error *error) {
    const int file = openat(folder, name, OPEN_TO_READ | O_NOFOLLOW);
    return read_and_close(check_open(file, path, limit, size, error), path, limit, size, error);
}

char *file_read_input(size_t limit, size_t *size, Error *error) {
    return read_all(STDIN_FILENO, "standard input", limit, 1 << 16, size, error);
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

const char *file_make_cause(const char *path, int cause) {
    struct stat status;
    char folder[PATH_MAX] = ".";
    const size_t length = file_folder_length(path);
    if (cause != ENOENT || length >= sizeof folder || lstat(path, &status) == 0) return strerror(cause);
    if (length > 0) snprintf(folder, sizeof folder, "%.*s", (int)length, path);
    return is_directory(folder) ? "nothing new can be made there" : "its folder does not exist";
}

bool file_make_directory(const char *path, Error *error) {
    char part[PATH_MAX];
    size_t length = strlen(path);
    if (length == 0 || length >= sizeof part)
        return error_system(error, path, "cannot make this folder: %s", strerror(length == 0 ? ENOENT : ENAMETOOLONG));
    for (size_t end = 1; end <= length; end++) {
        if (path[end] != '/' && path[end] != '\0') continue;
        snprintf(part, sizeof part, "%.*s", (int)end, path);
        if (mkdir(part, 0777) == 0) continue;
        const int cause = errno;
        if (!is_directory(part))
            return error_system(error, part, "cannot make this folder: %s", file_make_cause(part, cause));
    }
    return true;
}

const char *(*file_elsewhere)(const char *path);

bool file_path(char *path, size_t size, Error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(path, size, format, arguments);
    va_end(arguments);
    return (length >= 0 && (size_t)length < size) ||
           error_input(error, "path", "%.200s... is longer than %zu bytes", path, size - 1);
}

bool folder_error(const char *path, Error *error) {
    int cause = errno;
    bool nameless = cause == ENOENT || cause == ENOTDIR || cause == ENAMETOOLONG || cause == ELOOP;
    return nameless ? error_input(error, path, "cannot be read: %s", strerror(cause))
                    : error_system(error, path, "cannot be read: %s", strerror(cause));
}

typedef struct Walk {
    const char *root;
    char real[PATH_MAX]; /* the root without links; "" until a link is met */
    bool (*wanted)(const char *name);
    bool recursive;
    FolderList *list;
    FolderList folders; /* below the root, with a slash at the end; those behind the current one are to be read */
} Walk;

/* Adds `folder` + `name` + `ending`. */
static bool add(FolderList *list, const char *folder, const char *name, const char *ending, Error *error) {
    size_t size = strlen(folder) + strlen(name) + strlen(ending) + 1;
    char *whole = malloc(size);
    if (whole == NULL || !array_reserve((void **)&list->names, &list->capacity, list->count + 1, sizeof *list->names)) {
        free(whole);
        return error_memory(error, name);
    }
    snprintf(whole, size, "%s%s%s", folder, name, ending);
    list->names[list->count++] = whole;
    return true;
}

/* A link leads to a place that the walk reaches without it, or is refused. */
static bool check_link(Walk *walk, const char *path, Error *error) {
    char target[PATH_MAX];
    if (walk->real[0] == '\0' && realpath(walk->root, walk->real) == NULL) return folder_error(walk->root, error);
    if (realpath(path, target) == NULL) return folder_error(path, error);
    size_t length = strlen(walk->real);
    if (length == 1) length = 0; /* "/" */
    if (strncmp(target, walk->real, length) != 0 || (target[length] != '/' && target[length] != '\0'))
        return error_input(error, path, "is a link to %s, out of %s; such links are not followed", target, walk->root);
    return strstr(target + length, "/.") == NULL ||
           error_input(error, path, "is a link to %s, which is hidden; such links are not followed", target);
}

static bool add_entry(Walk *walk, int at, const char *folder, const char *name, Error *error) {
    struct stat status, target;
    char path[PATH_MAX];
    const bool wanted = walk->wanted(name), inside = folder[0] != '\0';
    if (name[0] == '.') return true;
    if (fstatat(at, name, &status, AT_SYMLINK_NOFOLLOW) != 0)
        return error_system(error, name, "in %s/%s: cannot be read: %s", walk->root, folder, strerror(errno));
    if (S_ISDIR(status.st_mode)) return add(&walk->folders, folder, name, "/", error);
    if (S_ISLNK(status.st_mode)) {
        if (!file_path(path, sizeof path, error, "%s/%s%s", walk->root, folder, name)) return false;
        if (fstatat(at, name, &target, 0) != 0)
            return (!wanted && (errno == ENOENT || errno == ELOOP)) || folder_error(path, error);
        const bool is_folder = S_ISDIR(target.st_mode);
        if ((!is_folder && !wanted) || (!walk->recursive && (is_folder || inside))) return true;
        if (!check_link(walk, path, error)) return false;
        if (is_folder) return true;
    }
    if (!wanted) return true;
    if (walk->recursive || !inside) return add(walk->list, folder, name, "", error);
    walk->list->skipped++;
    return true;
}

static bool read_folder(Walk *walk, const char *folder, Error *error) {
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/%s", walk->root, folder)) return false;
    DIR *directory = opendir(path);
    if (directory == NULL)
        return folder[0] == '\0' ? folder_error(path, error)
                                 : error_system(error, path, "cannot be read: %s", strerror(errno));
    bool ok = true;
    const struct dirent *entry = NULL;
    do {
        errno = 0; /* readdir() returns NULL at the end and on failure */
        entry = readdir(directory);
        if (entry != NULL)
            ok = add_entry(walk, dirfd(directory), folder, entry->d_name, error);
        else if (errno != 0)
            ok = error_system(error, path, "cannot be read: %s", strerror(errno));
    } while (ok && entry != NULL);
    closedir(directory);
    return ok;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

bool folder_list(FolderList *list, const char *folder, bool (*wanted)(const char *name), bool recursive, Error *error) {
    *list = (FolderList){.count = 0};
    Walk walk = {.root = folder, .wanted = wanted, .recursive = recursive, .list = list};
    bool ok = read_folder(&walk, "", error);
    for (size_t i = 0; ok && i < walk.folders.count; i++) ok = read_folder(&walk, walk.folders.names[i], error);
    folder_list_free(&walk.folders);
    if (ok && list->count > 0) qsort(list->names, list->count, sizeof *list->names, by_name);
    if (!ok) folder_list_free(list);
    return ok;
}

void folder_list_free(FolderList *list) {
    for (size_t i = 0; i < list->count; i++) free(list->names[i]);
    free(list->names);
    *list = (FolderList){.count = 0};
}

bool lfs_pointer_refuse(const void *data, size_t size, const char *path, Error *error) {
    static const char start[] = "version https://git-lfs.github.com/spec/";
    if (size < sizeof start || memcmp(data, start, sizeof start - 1) != 0) return true;
    return error_input(error, path, "a Git LFS pointer, not the file itself; run: git lfs pull");
}
