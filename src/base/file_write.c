/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* O_TMPFILE */
/* Files that are whole or absent: written beside the name, then fsync and rename; drafts, which are written piece by
   piece; and folders that one process writes into at a time. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* What a file is to hold: a block of memory, or all of an open file. */
typedef struct Contents {
    const char *data;
    size_t size;
    int draft; /* -1: the block */
} Contents;

/* A file that gets its name when it is whole. Before, it has none where the file system can do that. Otherwise, and for
   the moment in which it replaces a file, it has a temporary name, which follows from the one that it shall have, and
   is locked: what a killed process left is not locked, and the next process that wants the name removes it. Functions
   set errno when they fail. */
typedef struct Temporary {
    int at;              /* the open directory that names are relative to, or AT_FDCWD */
    int file;            /* open for reading and writing; -1: none */
    char name[PATH_MAX]; /* "": none */
} Temporary;

/* Machines that share a folder may not see each other's locks. This is random, drawn when a kernel starts. */
static uint64_t machine_hash(void) {
    char id[64];
    const int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    const ssize_t size = file >= 0 ? file_read_all(file, id, sizeof id) : 0;
    if (file >= 0) close(file);
    return hash_xxh3(id, size > 0 ? (size_t)size : 0);
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Removes a temporary file that no process has locked; false if there is one in use. The lock is held while the name is
   removed; else a process could take the file in between. Over NFS, only a file that is open for writing can be
   locked. */
static bool remove_dead(int at, const char *name) {
    struct stat status, named;
    const int file = openat(at, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return errno == ENOENT;
    const bool dead = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
                      flock(file, LOCK_EX | LOCK_NB) == 0;
    if (dead && fstatat(at, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && same_file(&status, &named))
        unlinkat(at, name, 0);
    close(file);
    return dead;
}

/* Takes the lock that files in use have. False if another process has it, or has removed the file, as it found it
   unlocked. True where the file system has no locks. */
static bool lock_as_in_use(int file) {
    struct stat status;
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    return fstat(file, &status) != 0 || status.st_nlink > 0;
}

/* A file without a name gets one through /proc. */
static bool link_to(Temporary *temporary, const char *path) {
    char descriptor[64];
    if (temporary->name[0] != '\0') return linkat(temporary->at, temporary->name, temporary->at, path, 0) == 0;
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", temporary->file);
    return linkat(AT_FDCWD, descriptor, temporary->at, path, AT_SYMLINK_FOLLOW) == 0;
}

/* Gives the file, or a new one if there is none, a temporary name for `path`. */
static bool take_name(Temporary *temporary, const char *path) {
    enum { ATTEMPTS = 1000 };
    const size_t folder = file_folder_length(path);
    const uint64_t hashes[] = {machine_hash(), hash_xxh3(path + folder, strlen(path + folder))};
    const bool makes = temporary->file < 0;
    char name[PATH_MAX];
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (snprintf(name, sizeof name, "%.*s.twinbox-%016" PRIx64 "-%d.tmp", (int)folder, path,
                     hash_xxh3(hashes, sizeof hashes), attempt) >= (int)sizeof name)
            return errno = ENAMETOOLONG, false;
        do {
            /* Not mkstemp: its files are readable by their owner only, whatever the umask. */
            if (makes)
                temporary->file = openat(temporary->at, name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            else
                flock(temporary->file, LOCK_EX | LOCK_NB); /* before it has the name */
            if (makes ? temporary->file >= 0 && lock_as_in_use(temporary->file) : link_to(temporary, name)) {
                strcpy(temporary->name, name);
                return true;
            }
            if (makes && temporary->file >= 0) {
                close(temporary->file);
                temporary->file = -1;
                break;
            }
            if (errno != EEXIST) return false;
        } while (remove_dead(temporary->at, name));
    }
    return false;
}

/* Opens an empty file in the folder of `path`. */
static bool open_temporary(Temporary *temporary, int at, const char *path) {
    char folder[PATH_MAX];
    const int length = (int)file_folder_length(path);
    *temporary = (Temporary){.at = at, .file = -1};
    if (snprintf(folder, sizeof folder, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >= PATH_MAX)
        return errno = ENAMETOOLONG, false;
    if (access("/proc/self/fd", X_OK) != 0) return take_name(temporary, path);
    temporary->file = openat(at, folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (temporary->file >= 0) return true;
    return (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL) && take_name(temporary, path);
}

static bool remove_name(Temporary *temporary) {
    const bool done = temporary->name[0] == '\0' || unlinkat(temporary->at, temporary->name, 0) == 0;
    temporary->name[0] = '\0';
    return done;
}

/* Leaves errno unchanged. */
static void close_temporary(Temporary *temporary) {
    const int cause = errno;
    remove_name(temporary);
    if (temporary->file >= 0) close(temporary->file);
    errno = cause;
}

static bool rename_to(Temporary *temporary, const char *path) {
    if (temporary->name[0] == '\0') {
        /* A link, unlike a rename, needs no other name before, but cannot replace a file. */
        if (link_to(temporary, path)) return true;
        if (errno != EEXIST || !take_name(temporary, path)) return false;
    }
    if (renameat(temporary->at, temporary->name, temporary->at, path) != 0) return false;
    temporary->name[0] = '\0';
    return true;
}

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

/* What close() would report, while the lock lasts. */
static bool flush(int file, bool wait) {
    if (wait && fsync(file) != 0) return false;
    const int copy = dup(file);
    return copy >= 0 && close(copy) == 0;
}

/* Makes the contents the file `path`, replacing one of that name, or (`replace` false: EEXIST) only if there is
   none. */
static bool place(int at, const char *path, const Contents *contents, bool wait, bool replace) {
    Temporary whole = {.at = at, .file = contents->draft};
    bool done = false;
    if (contents->draft >= 0 && at == AT_FDCWD) {
        if (!flush(contents->draft, wait)) return false;
        done = rename_to(&whole, path); /* a draft need not be copied where it can get the name itself */
        remove_name(&whole);
    }
    if (!done) {
        if (!open_temporary(&whole, at, path)) return false;
        done = write_contents(whole.file, contents) && flush(whole.file, wait) &&
               (replace ? rename_to : link_to)(&whole, path);
        close_temporary(&whole);
    }
    return done && (!wait || sync_folder(at, path));
}

bool standard_output_is(const struct stat *status) {
    struct stat output;
    return fstat(STDOUT_FILENO, &output) == 0 && same_file(&output, status);
}

/* For devices, pipes and the target of /dev/stdout. Closes also after a failure, and keeps errno of the first one. */
static bool write_into(int file, const Contents *contents) {
    if (file < 0) return false;
    const bool done = write_contents(file, contents);
    const int cause = errno;
    if (close(file) != 0 && done) return false;
    errno = cause;
    return done;
}

static bool put(const char *path, const Contents *contents, bool wait) {
    struct stat status;
    if (path_is_standard(path)) return write_into(dup(standard_output()), contents);
    if (lstat(path, &status) != 0) return errno == ENOENT && place(AT_FDCWD, path, contents, wait, true);
    bool is_link = S_ISLNK(status.st_mode);
    if (is_link && stat(path, &status) != 0) return false;
    if (standard_output_is(&status)) return write_into(dup(STDOUT_FILENO), contents);
    if (!S_ISREG(status.st_mode)) return write_into(open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC), contents);
    if (!is_link) return place(AT_FDCWD, path, contents, wait, true);
    char target[PATH_MAX];
    return realpath(path, target) != NULL && place(AT_FDCWD, target, contents, wait, true);
}

static bool finish(bool written, const char *path, size_t size, Error *error) {
    if (!written) return error_system(error, path, "cannot write: %s", file_make_cause(path, errno));
    trace_line("wrote %s, %zu bytes", path, size);
    return true;
}

bool file_write(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, &(Contents){data, size, -1}, true), path, size, error);
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
    const bool done = place(AT_FDCWD, path, &(Contents){data, size, -1}, true, false);
    if (!done && errno == EEXIST) return error_input(error, path, "exists already, and is not overwritten");
    return finish(done, path, size, error);
}

bool file_write_at(int folder, const char *name, const char *path, const void *data, size_t size, Error *error) {
    return finish(place(folder, name, &(Contents){data, size, -1}, true, true), path, size, error);
}

bool file_write_soon(const char *path, const void *data, size_t size, Error *error) {
    return finish(put(path, &(Contents){data, size, -1}, false), path, size, error);
}

bool file_remove(const char *path, Error *error) {
    return unlink(path) == 0 || errno == ENOENT || error_system(error, path, "cannot be removed: %s", strerror(errno));
}

bool file_sync(const char *path, Error *error) {
    return sync_entry(path) || error_system(error, path, "cannot write: %s", strerror(errno));
}

int file_draft(const char *path, Error *error) {
    char folder[PATH_MAX];
    struct stat status;
    Temporary draft;
    const char *temporary = getenv("TMPDIR");
    /* Where it can become that file; for pipes and devices, in the folder for temporary files. */
    const bool passes = path_is_standard(path) ||
                        (stat(path, &status) == 0 && (!S_ISREG(status.st_mode) || standard_output_is(&status)));
    if (passes)
        snprintf(folder, sizeof folder, "%.*s/draft", PATH_MAX - 10,
                 temporary != NULL && temporary[0] != '\0' ? temporary : "/tmp");
    else if (realpath(path, folder) == NULL)
        snprintf(folder, sizeof folder, "%s", path);
    if (open_temporary(&draft, AT_FDCWD, folder) && remove_name(&draft)) return draft.file;
    const int cause = errno;
    error_system(error, folder, "cannot write: %s", file_make_cause(folder, cause));
    errno = cause;
    close_temporary(&draft);
    return -1;
}

bool file_draft_write(int draft, const char *path, const void *data, size_t size, Error *error) {
    return file_write_all(draft, data, size) || error_system(error, path, "cannot write: %s", strerror(errno));
}

bool file_draft_publish(int draft, const char *path, Error *error) {
    const off_t size = lseek(draft, 0, SEEK_END);
    return finish(put(path, &(Contents){.draft = draft}, true), path, (size_t)size, error);
}

bool folder_reserve(const char *folder, Error *error) {
    enum { FOLDERS = 64 }; /* more than a command or a test writes into */
    static struct stat reserved[FOLDERS];
    static int count;
    static const double patience = 3; /* s: the drawing processes of a render that was killed end after their frame */
    const double begun = clock_seconds();
    struct stat status;
    if (!file_make_directory(folder, error)) return false;
    const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    /* A folder that cannot be read may be one that can be written into. */
    if (file < 0 && errno == EACCES) return true;
    if (file < 0 || fstat(file, &status) != 0) {
        error_system(error, folder, "cannot be opened: %s", strerror(errno));
        if (file >= 0) close(file);
        return false;
    }
    for (int i = 0; i < count; i++)
        if (same_file(&reserved[i], &status)) return close(file), true;
    while (flock(file, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR)) { /* else: no locks there */
        if (clock_seconds() - begun > patience) {
            close(file);
            return error_system(
                error, folder,
                "another process is writing into this folder; wait until it ends, or choose another name");
        }
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    }
    if (count < FOLDERS) reserved[count++] = status; /* the file stays open: its lock lasts as long as the process */
    return true;
}
