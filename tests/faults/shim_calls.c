/* SPDX-License-Identifier: GPL-3.0-or-later */
/* System calls. */
#define _GNU_SOURCE
#include "shim.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* CALL(result type, name, kind, result of a failure, parameters, arguments) */
#define CALL(TYPE, NAME, KIND, FAILURE, PARAMETERS, ARGUMENTS) \
    TYPE NAME PARAMETERS {                                     \
        REAL(NAME);                                            \
        return FAILS(KIND) ? FAILURE : real ARGUMENTS;         \
    }

/* Also a close that fails has closed. */
#define CLOSING(TYPE, NAME)                           \
    int NAME(TYPE what) {                             \
        REAL(NAME);                                   \
        const bool fails = FAILS(CALL_CLOSE);         \
        const int cause = errno, status = real(what); \
        if (fails) errno = cause;                     \
        return fails ? -1 : status;                   \
    }

/* Half of the bytes in mode short. */
#define MOVING(NAME, KIND, PARAMETERS, ARGUMENTS)               \
    ssize_t NAME PARAMETERS {                                   \
        REAL(NAME);                                             \
        const Mode mode = STRIKES(KIND);                        \
        if (mode == MODE_FAIL || mode == MODE_EINTR) return -1; \
        if (mode == MODE_SHORT && size > 1) size /= 2;          \
        return real ARGUMENTS;                                  \
    }

static mode_t permissions(int how, va_list more) {
    return (how & O_CREAT) != 0 || (how & O_TMPFILE) == O_TMPFILE ? va_arg(more, mode_t) : 0;
}

int open(const char *path, int how, ...) {
    REAL(open);
    va_list more;
    va_start(more, how);
    const mode_t mode = permissions(how, more);
    va_end(more);
    return FAILS(CALL_OPEN) ? -1 : real(path, how, mode);
}

int openat(int at, const char *path, int how, ...) {
    REAL(openat);
    va_list more;
    va_start(more, how);
    const mode_t mode = permissions(how, more);
    va_end(more);
    return FAILS(CALL_OPEN) ? -1 : real(at, path, how, mode);
}

CALL(DIR *, opendir, CALL_OPEN, NULL, (const char *path), (path))
CALL(DIR *, fdopendir, CALL_OPEN, NULL, (int file), (file))
CALL(int, mkstemp, CALL_OPEN, -1, (char *path), (path))

MOVING(read, CALL_READ, (int file, void *data, size_t size), (file, data, size))
MOVING(pread, CALL_READ, (int file, void *data, size_t size, off_t at), (file, data, size, at))
MOVING(write, CALL_WRITE, (int file, const void *data, size_t size), (file, data, size))
MOVING(pwrite, CALL_WRITE, (int file, const void *data, size_t size, off_t at), (file, data, size, at))
MOVING(send, CALL_WRITE, (int file, const void *data, size_t size, int how), (file, data, size, how))

CALL(int, fsync, CALL_FSYNC, -1, (int file), (file))
CALL(int, fdatasync, CALL_FSYNC, -1, (int file), (file))
CALL(int, syncfs, CALL_FSYNC, -1, (int file), (file))

CALL(int, rename, CALL_RENAME, -1, (const char *from, const char *to), (from, to))
CALL(int, renameat, CALL_RENAME, -1, (int from_at, const char *from, int to_at, const char *to),
     (from_at, from, to_at, to))
CALL(int, link, CALL_RENAME, -1, (const char *from, const char *to), (from, to))
CALL(int, linkat, CALL_RENAME, -1, (int from_at, const char *from, int to_at, const char *to, int how),
     (from_at, from, to_at, to, how))

CALL(int, unlink, CALL_UNLINK, -1, (const char *path), (path))
CALL(int, unlinkat, CALL_UNLINK, -1, (int at, const char *path, int how), (at, path, how))
CALL(int, remove, CALL_UNLINK, -1, (const char *path), (path))
CALL(int, rmdir, CALL_UNLINK, -1, (const char *path), (path))

CALL(struct dirent *, readdir, CALL_READDIR, NULL, (DIR * directory), (directory))
CALL(int, nftw, CALL_READDIR, -1, (const char *path, __nftw_func_t visit, int files, int how),
     (path, visit, files, how))

CLOSING(int, close)
CLOSING(DIR *, closedir)

CALL(int, stat, CALL_STAT, -1, (const char *restrict path, struct stat *restrict status), (path, status))
CALL(int, lstat, CALL_STAT, -1, (const char *restrict path, struct stat *restrict status), (path, status))
CALL(int, fstat, CALL_STAT, -1, (int file, struct stat *status), (file, status))
CALL(int, fstatat, CALL_STAT, -1, (int at, const char *restrict path, struct stat *restrict status, int how),
     (at, path, status, how))
CALL(int, access, CALL_STAT, -1, (const char *path, int how), (path, how))
CALL(ssize_t, readlink, CALL_STAT, -1, (const char *restrict path, char *restrict target, size_t size),
     (path, target, size))
CALL(char *, realpath, CALL_STAT, NULL, (const char *restrict path, char *restrict target), (path, target))

CALL(int, mkdir, CALL_MKDIR, -1, (const char *path, mode_t mode), (path, mode))
CALL(int, mkdirat, CALL_MKDIR, -1, (int at, const char *path, mode_t mode), (at, path, mode))
CALL(char *, mkdtemp, CALL_MKDIR, NULL, (char *path), (path))

CALL(int, pipe, CALL_PROCESS, -1, (int ends[2]), (ends))
CALL(int, socketpair, CALL_PROCESS, -1, (int domain, int type, int protocol, int ends[2]),
     (domain, type, protocol, ends))
CALL(int, dup, CALL_PROCESS, -1, (int file), (file))
CALL(int, dup2, CALL_PROCESS, -1, (int file, int as), (file, as))
CALL(int, posix_spawnp, CALL_PROCESS, EAGAIN,
     (pid_t *restrict process, const char *restrict program, const posix_spawn_file_actions_t *restrict actions,
      const posix_spawnattr_t *restrict attributes, char *const arguments[restrict], char *const environment[restrict]),
     (process, program, actions, attributes, arguments, environment))
CALL(int, pthread_create, CALL_PROCESS, EAGAIN,
     (pthread_t *restrict thread, const pthread_attr_t *restrict attributes, void *(*work)(void *),
      void *restrict argument),
     (thread, attributes, work, argument))

CALL(int, poll, CALL_WAIT, -1, (struct pollfd * files, nfds_t count, int timeout), (files, count, timeout))
CALL(pid_t, waitpid, CALL_WAIT, -1, (pid_t process, int *status, int how), (process, status, how))

pid_t fork(void) {
    REAL(fork);
    if (FAILS(CALL_PROCESS)) return -1;
    const pid_t child = real();
    if (child == 0) shim_register_process();
    return child;
}
