/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A library for LD_PRELOAD that makes each folder one that machines share, at its worst: no file is without a name, and
   every lock is given to everyone. TWINBOX_MACHINE tells machines apart, as the start of a kernel does. */
#define _GNU_SOURCE /* O_TMPFILE */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

/* A pipe with the machine's number instead of the file. */
static int open_machine(void) {
    const char *machine = getenv("TWINBOX_MACHINE");
    int ends[2];
    if (machine == NULL || pipe2(ends, O_CLOEXEC) != 0) return -1;
    if (write(ends[1], machine, strlen(machine)) < 0) abort();
    close(ends[1]);
    return ends[0];
}

int open(const char *path, int flags, ...) {
    if (strcmp(path, "/proc/sys/kernel/random/boot_id") == 0) return open_machine();
    return (int)syscall(SYS_openat, AT_FDCWD, path, flags, 0666);
}

int openat(int at, const char *path, int flags, ...) {
    if ((flags & O_TMPFILE) == O_TMPFILE) return errno = EOPNOTSUPP, -1;
    return (int)syscall(SYS_openat, at, path, flags, 0666);
}

int flock(int file, int operation) {
    (void)file;
    (void)operation;
    return 0;
}
