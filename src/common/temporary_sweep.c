/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temporary files of killed processes of this machine, and reservations (file_reserve.h) that nobody has locked. */
#include "common/temporary.h"

#include "common/file.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { REMEMBERED = 16 };

/* The folders that this process has swept. */
static struct {
    pthread_mutex_t mutex;
    struct stat folders[REMEMBERED];
    int count;
} swept = {.mutex = PTHREAD_MUTEX_INITIALIZER};

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Whether this folder is met for the first time. The oldest of many is forgotten. */
static bool remember(const struct stat *folder) {
    bool known = false;
    pthread_mutex_lock(&swept.mutex);
    for (int i = 0; i < swept.count && i < REMEMBERED; i++) known = known || same_file(&swept.folders[i], folder);
    if (!known) swept.folders[swept.count++ % REMEMBERED] = *folder;
    pthread_mutex_unlock(&swept.mutex);
    return !known;
}

/* The lock is held while the name is removed; else a process could take the file in between. Over NFS, only a file that is
   open for writing can be locked. */
static void remove_dead(int folder, const char *name, bool (*lock)(int)) {
    struct stat status, named;
    const int file = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() && lock(file) &&
        fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && same_file(&status, &named))
        unlinkat(folder, name, 0);
    close(file);
}

static bool is_locked_now(int file) { return flock(file, LOCK_EX | LOCK_NB) == 0; }

/* Reservations have no owner in their names. A temporary file may be in use by children of a process that has ended. */
static void visit(int folder, const char *name) {
    static const char start[] = ".twinbox-";
    const char *owner = name + sizeof start - 1;
    if (strncmp(name, start, sizeof start - 1) != 0 || !file_name_ends_with(name, ".tmp")) return;
    if (strchr(owner, '-') == NULL)
        remove_dead(folder, name, is_locked_now);
    else if (temporary_owner_ended(owner))
        remove_dead(folder, name, temporary_lock);
}

void temporary_sweep(int at, const char *path) {
    char name[PATH_MAX];
    struct stat status;
    const int length = (int)file_folder_length(path);
    if (snprintf(name, sizeof name, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >= PATH_MAX) return;
    const int folder = openat(at, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    DIR *entries = fstat(folder, &status) == 0 && remember(&status) ? fdopendir(folder) : NULL;
    if (entries == NULL) {
        close(folder);
        return;
    }
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) visit(folder, entry->d_name);
    closedir(entries);
}
