/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Installed scenes and networks. */
#include "base/base.h"
#include "base/file.h"
#include "cli/installed.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

/* What was found; a list, because callers keep the paths. */
typedef struct Found {
    struct Found *next;
    size_t name; /* where in the path its name below the installed data begins */
    char path[PATH_SIZE];
} Found;

static Found *all_found;

/* The path below TWINBOX_DATA, which is relative to the program's folder: an installed prefix can be moved. */
static bool installed_find(char found[PATH_SIZE], const char *path) {
    char program[PATH_SIZE];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) return false;
    program[length] = '\0';
    Error ignored = {0};
    return file_path(found, PATH_SIZE, &ignored, "%.*s%s/%s", (int)file_folder_length(program), program, TWINBOX_DATA,
                     path) &&
           access(found, R_OK) == 0;
}

/* Where a scene is looked for by its name. */
static const char *const scene_folders[] = {"scenes", "scenes/families", "scenes/stability"};
enum { SCENE_FOLDERS = sizeof scene_folders / sizeof *scene_folders };

const char *installed_path(const char *path) {
    if (path[0] == '/' || access(path, F_OK) == 0) return path;
    Found *found = malloc(sizeof *found);
    bool there = found != NULL && installed_find(found->path, path);
    if (there) found->name = strlen(found->path) - strlen(path);
    /* A name without "/" and "." is a scene's. */
    for (int i = 0; found != NULL && !there && strpbrk(path, "./") == NULL && i < SCENE_FOLDERS; i++) {
        char scene[PATH_SIZE];
        if (!file_path(scene, sizeof scene, &(Error){0}, "%s/%s.yaml", scene_folders[i], path)) break;
        there = access(scene, R_OK) == 0;
        if (there) {
            memcpy(found->path, scene, sizeof scene);
            found->name = 0;
        } else if ((there = installed_find(found->path, scene)))
            found->name = strlen(found->path) - strlen(scene);
    }
    if (!there) {
        free(found);
        return path;
    }
    found->next = all_found;
    all_found = found;
    return found->path;
}

const char *installed_name(const char *path) {
    for (const Found *found = all_found; found != NULL; found = found->next)
        if (strcmp(found->path, path) == 0) return path + found->name;
    return path;
}
