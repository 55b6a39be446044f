/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve_place.h"

#include "common/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OPEN_FOLDER = O_RDONLY | O_DIRECTORY | O_CLOEXEC };

static bool open_failed(const char *path, Error *error) {
    int cause = errno;
    return cause == ELOOP || cause == ENOTDIR || cause == EACCES
               ? error_input(error, path, "its folder cannot be opened, or is a link: %s", strerror(cause))
               : error_system(error, path, "its folder cannot be opened: %s", strerror(cause));
}

/* Steps from an open folder into one in it. Closes the first. */
static int step_into(int folder, const char *name, bool create) {
    int next = openat(folder, name, OPEN_FOLDER | O_NOFOLLOW);
    if (next < 0 && errno == ENOENT && create && (mkdirat(folder, name, 0777) == 0 || errno == EEXIST))
        next = openat(folder, name, OPEN_FOLDER | O_NOFOLLOW);
    int cause = errno;
    close(folder);
    errno = cause;
    return next;
}

bool place_open(Place *place, const char *root, const char *name, bool create, Error *error) {
    if (!file_path(place->path, sizeof place->path, error, "%s/%s", root, name)) return false;
    place->folder = open(root, OPEN_FOLDER);
    place->name = name;
    for (const char *slash; place->folder >= 0 && (slash = strchr(place->name, '/')) != NULL;) {
        char part[NAME_MAX + 1];
        if (snprintf(part, sizeof part, "%.*s", (int)(slash - place->name), place->name) >= (int)sizeof part) {
            close(place->folder);
            return error_input(error, place->path, "the name of a folder is too long");
        }
        place->folder = step_into(place->folder, part, create);
        place->name = slash + 1;
    }
    return place->folder >= 0 || errno == ENOENT || open_failed(place->path, error);
}

void place_close(const Place *place) {
    if (place->folder >= 0) close(place->folder);
}
