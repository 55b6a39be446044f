/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/lock.h"

#include "common/clock.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <time.h>

/* The process that has locked a file: flock() itself does not tell. 0: unknown, or it has ended. */
static long find_holder(const struct stat *file) {
    char line[256];
    long holder = 0;
    FILE *locks = fopen("/proc/locks", "re");
    if (locks == NULL) return 0;
    while (holder == 0 && fgets(line, sizeof line, locks) != NULL) {
        long process;
        unsigned major_number, minor_number;
        unsigned long long inode;
        if (sscanf(line, "%*d: FLOCK ADVISORY WRITE %ld %x:%x:%llu", &process, &major_number, &minor_number, &inode) ==
                4 &&
            inode == file->st_ino && major_number == major(file->st_dev) && minor_number == minor(file->st_dev))
            holder = process;
    }
    fclose(locks);
    return holder > 0 && (kill((pid_t)holder, 0) == 0 || errno == EPERM) ? holder : 0;
}

static bool refuse(const char *path, const char *what, long holder, Error *error) {
    char name[48] = "another process";
    if (holder > 0) snprintf(name, sizeof name, "another process (%ld)", holder);
    return error_system(error, path, "%s %s; wait until it ends, or choose another name", name, what);
}

/* The drawing processes of a render that was killed end after their frame, which must not replace one drawn later. */
bool lock_take(int file, const char *path, const char *what, Error *error) {
    struct stat status;
    static const double patience = 0.2, patience_with_children = 30; /* s */
    const double begun = clock_seconds();
    while (flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) return true;
        if (fstat(file, &status) != 0) return error_system(error, path, "cannot be locked: %s", strerror(errno));
        const long holder = find_holder(&status);
        if (clock_seconds() - begun > (holder > 0 ? patience : patience_with_children))
            return refuse(path, what, holder, error);
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    }
    return true;
}
