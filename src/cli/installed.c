/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/installed.h"

#include "common/file.h"
#include "common/folder.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

/* What was found; a list, because callers keep the paths. */
typedef struct Found {
    struct Found *next;
    char path[PATH_SIZE];
} Found;

static Found *all_found;

/* The path below TWINBOX_DATA, which is relative to the program's folder: an installed prefix can be moved. */
static bool find(char found[PATH_SIZE], const char *path) {
    char program[PATH_SIZE];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) return false;
    program[length] = '\0';
    Error ignored = {0};
    return file_path(found, PATH_SIZE, &ignored, "%.*s%s/%s", (int)file_folder_length(program), program, TWINBOX_DATA,
                     path) &&
           access(found, R_OK) == 0;
}

static bool find_scene(char found[PATH_SIZE], const char *name) {
    static const char *const folders[] = {"scenes", "scenes/families", "scenes/stability"};
    if (strpbrk(name, "./") != NULL) return false;
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        char path[PATH_SIZE];
        Error ignored = {0};
        if (!file_path(path, sizeof path, &ignored, "%s/%s.yaml", folders[i], name)) return false;
        if (access(path, R_OK) == 0) return memcpy(found, path, sizeof path), true;
        if (find(found, path)) return true;
    }
    return false;
}

const char *installed_path(const char *path) {
    if (path[0] == '/' || access(path, F_OK) == 0) return path;
    Found *found = malloc(sizeof *found);
    if (found == NULL || !(find(found->path, path) || find_scene(found->path, path))) {
        free(found);
        return path;
    }
    found->next = all_found;
    all_found = found;
    return found->path;
}

static bool is_scene(const char *name) {
    const char *ending = strrchr(name, '.');
    return ending != NULL && strcmp(ending, ".yaml") == 0;
}

void installed_scenes(void (*found)(const char *path, void *context), void *context) {
    char folder[PATH_SIZE], path[PATH_SIZE];
    FolderList list;
    Error ignored = {0};
    if (!find(folder, "scenes") || !folder_list(&list, folder, is_scene, true, &ignored)) return;
    for (size_t i = 0; i < list.count; i++)
        if (file_path(path, sizeof path, &ignored, "scenes/%s", list.names[i]) && access(path, F_OK) != 0)
            found(path, context);
    folder_list_free(&list);
}
