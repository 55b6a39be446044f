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

/* Whether the path is to blame, not the system. */
static bool is_input(int cause) {
    return cause == ELOOP || cause == ENOTDIR || cause == EACCES || cause == ENOENT || cause == ENAMETOOLONG;
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

/* Steps into each folder of *path that ends with a slash; *path moves behind the last. Closes the first. */
static int walk(int folder, const char **path, bool create) {
    for (const char *slash; folder >= 0 && (slash = strchr(*path, '/')) != NULL;) {
        char part[NAME_MAX + 1];
        const size_t length = (size_t)(slash - *path);
        if (length >= sizeof part) {
            close(folder);
            errno = ENAMETOOLONG;
            return -1;
        }
        memcpy(part, *path, length);
        part[length] = '\0';
        if (length > 0 && strcmp(part, ".") != 0) folder = step_into(folder, part, create);
        *path = slash + 1;
    }
    return folder;
}

bool root_open(Root *root, const char *path, Error *error) {
    *root = (Root){open(path, OPEN_FOLDER), path};
    if (root->folder >= 0) return true;
    const int cause = errno;
    return is_input(cause) ? error_input(error, path, "the folder cannot be opened: %s", strerror(cause))
                           : error_system(error, path, "the folder cannot be opened: %s", strerror(cause));
}

const char *path_below_current(const char *path) {
    char current[PATH_MAX];
    if (path[0] == '/') {
        const size_t length = getcwd(current, sizeof current) != NULL ? strlen(current) : 0;
        if (length < 2 || strncmp(path, current, length) != 0 || (path[length] != '/' && path[length] != '\0'))
            return NULL;
        path += length + strspn(path + length, "/");
    }
    for (const char *part = path; (part = strstr(part, "..")) != NULL; part += 2)
        if ((part == path || part[-1] == '/') && (part[2] == '/' || part[2] == '\0')) return NULL;
    return path;
}

bool root_open_below(Root *root, const char *path, const char *report, Error *error) {
    char whole[PATH_MAX];
    const char *relative = path_below_current(path), *rest = whole;
    *root = (Root){-1, path};
    if (relative == NULL)
        return error_input(error, report,
                           "the expected folder '%.1000s' is not below the current directory; if it is "
                           "the one to change, state it: --expected DIR",
                           path);
    if (!file_path(whole, sizeof whole, error, "%s/", relative)) return false;
    root->folder = walk(open(".", OPEN_FOLDER), &rest, false);
    if (root->folder >= 0) return true;
    const int cause = errno;
    return is_input(cause) ? error_input(error, report,
                                         "the expected folder '%.1000s' cannot be opened without following links: "
                                         "%s; if it is the one to change, state it: --expected DIR",
                                         path, strerror(cause))
                           : error_system(error, path, "the folder cannot be opened: %s", strerror(cause));
}

void root_close(const Root *root) { close(root->folder); }

bool place_open(Place *place, const Root *root, const char *name, bool create, Error *error) {
    if (!file_path(place->path, sizeof place->path, error, "%s/%s", root->path, name)) return false;
    place->name = name;
    place->folder = walk(fcntl(root->folder, F_DUPFD_CLOEXEC, 0), &place->name, create);
    if (place->folder >= 0 || errno == ENOENT) return true;
    const int cause = errno;
    return is_input(cause)
               ? error_input(error, place->path, "its folder cannot be opened, or is a link: %s", strerror(cause))
               : error_system(error, place->path, "its folder cannot be opened: %s", strerror(cause));
}

void place_close(const Place *place) {
    if (place->folder >= 0) close(place->folder);
}
