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
    /* A name without "/" and "." is a scene's. */
    for (int i = 0; found != NULL && !there && strpbrk(path, "./") == NULL && i < SCENE_FOLDERS; i++) {
        char scene[PATH_SIZE];
        if (!file_path(scene, sizeof scene, &(Error){0}, "%s/%s.yaml", scene_folders[i], path)) break;
        there = access(scene, R_OK) == 0;
        if (there)
            memcpy(found->path, scene, sizeof scene);
        else
            there = installed_find(found->path, scene);
    }
    if (!there) {
        free(found);
        return path;
    }
    found->next = all_found;
    all_found = found;
    return found->path;
}

const char *installed_network(const char *method) {
    static const char key[] = "network=";
    const char *value = strstr(method, key);
    if (value == NULL || (value > method && value[-1] != ':' && value[-1] != ',')) return method;
    char path[PATH_SIZE];
    value += strlen(key);
    const int length = (int)strcspn(value, ",");
    Error ignored = {0};
    if (!file_path(path, sizeof path, &ignored, "%.*s", length, value)) return method;
    const char *found = installed_path(path);
    Found *text = found != path ? malloc(sizeof *text) : NULL;
    if (text == NULL || !file_path(text->path, sizeof text->path, &ignored, "%.*s%s%s", (int)(value - method), method,
                                   found, value + length)) {
        free(text);
        return method;
    }
    text->next = all_found;
    all_found = text;
    return text->path;
}
