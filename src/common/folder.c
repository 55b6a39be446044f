/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/folder.h"

#include "common/array.h"
#include "common/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

static bool add_file(Walk *walk, const char *folder, const char *name, Error *error) {
    if (walk->recursive || folder[0] == '\0') return add(walk->list, folder, name, "", error);
    walk->list->skipped++;
    return true;
}

/* Whether a link leads to a place that the walk reaches without it. */
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

static bool add_link(Walk *walk, int at, const char *folder, const char *name, Error *error) {
    char path[PATH_MAX];
    struct stat target;
    if (!file_path(path, sizeof path, error, "%s/%s%s", walk->root, folder, name)) return false;
    bool file = walk->wanted(name), inside = folder[0] != '\0';
    if (fstatat(at, name, &target, 0) != 0)
        return (!file && (errno == ENOENT || errno == ELOOP)) || folder_error(path, error);
    bool is_folder = S_ISDIR(target.st_mode);
    if ((!is_folder && !file) || (!walk->recursive && (is_folder || inside))) return true;
    return check_link(walk, path, error) && (is_folder || add_file(walk, folder, name, error));
}

static bool add_entry(Walk *walk, int at, const char *folder, const char *name, Error *error) {
    struct stat status;
    if (name[0] == '.') return true;
    if (fstatat(at, name, &status, AT_SYMLINK_NOFOLLOW) != 0)
        return error_system(error, name, "in %s/%s: cannot be read: %s", walk->root, folder, strerror(errno));
    if (S_ISLNK(status.st_mode)) return add_link(walk, at, folder, name, error);
    if (S_ISDIR(status.st_mode)) return add(&walk->folders, folder, name, "/", error);
    return !walk->wanted(name) || add_file(walk, folder, name, error);
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
