/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/folder_reserve.h"

#include "common/clock.h"
#include "common/file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <time.h>
#include <unistd.h>

/* A command writes into two folders at most. */
enum { FOLDERS = 8 };

/* The reserved folders. Their files stay open. */
static struct {
    struct stat status[FOLDERS];
    int files[FOLDERS], count;
} reserved;

static bool is_reserved(const struct stat *folder) {
    for (int i = 0; i < reserved.count && i < FOLDERS; i++)
        if (reserved.status[i].st_dev == folder->st_dev && reserved.status[i].st_ino == folder->st_ino) return true;
    return false;
}

/* Of more, the oldest is given back. */
static void keep(int file, const struct stat *folder) {
    const int place = reserved.count++ % FOLDERS;
    if (reserved.count > FOLDERS) close(reserved.files[place]);
    reserved.files[place] = file;
    reserved.status[place] = *folder;
}

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

static bool refuse(const char *folder, long holder, Error *error) {
    char name[48] = "another process";
    if (holder > 0) snprintf(name, sizeof name, "another process (%ld)", holder);
    return error_system(error, folder, "%s is writing into this folder; wait until it ends, or choose another folder",
                        name);
}

/* The drawing processes of a render that was killed end after their frame, which must not replace one drawn later. */
static bool take_lock(int file, const char *folder, const struct stat *status, Error *error) {
    static const double patience = 0.2, patience_with_children = 30; /* s */
    const double begun = clock_seconds();
    while (flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) return true;
        const long holder = find_holder(status);
        if (clock_seconds() - begun > (holder > 0 ? patience : patience_with_children))
            return refuse(folder, holder, error);
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    }
    return true;
}

bool folder_reserve(const char *folder, Error *error) {
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
    const bool known = is_reserved(&status), done = known || take_lock(file, folder, &status, error);
    if (done && !known)
        keep(file, &status);
    else
        close(file);
    return done;
}
