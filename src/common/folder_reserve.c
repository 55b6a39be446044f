/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/folder_reserve.h"

#include "common/file.h"
#include "common/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
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
    const bool known = is_reserved(&status),
               done = known || lock_take(file, folder, "is writing into this folder", error);
    if (done && !known)
        keep(file, &status);
    else
        close(file);
    return done;
}
