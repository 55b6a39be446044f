/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/shown.h"

#include "common/file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Errors are not reported: without a view or a run there are fewer names, and the comparison of runs reports a damaged
   run itself. */
static void read_runs(ShownFolder *folder) {
    for (int i = 0; i < folder->view.panel_count; i++) {
        char path[PATH_MAX];
        for (int k = 0; k < i; k++)
            if (strcmp(folder->view.panels[k].run, folder->view.panels[i].run) == 0) folder->runs[i] = folder->runs[k];
        if (folder->runs[i] == NULL &&
            file_path(path, sizeof path, &(Error){0}, "%s%s", folder->path, folder->view.panels[i].run))
            folder->runs[i] = trajectory_read(path, &(Error){0});
    }
}

static ShownFolder *read_folder(const char *picture, size_t length) {
    ShownFolder *folder = calloc(1, sizeof *folder);
    char path[PATH_MAX];
    if (folder == NULL || (folder->path = strndup(picture, length)) == NULL) {
        free(folder);
        return NULL;
    }
    if (file_path(path, sizeof path, &(Error){0}, "%smanifest.json", folder->path) &&
        view_read(&folder->view, path, &(Error){0}))
        read_runs(folder);
    return folder;
}

const ShownFolder *shown_find(Shown *shown, const char *picture) {
    size_t length = file_folder_length(picture);
    ShownFolder *found = NULL;
#pragma omp critical(shown_folders)
    {
        found = shown->first;
        while (found != NULL && (strncmp(found->path, picture, length) != 0 || found->path[length] != '\0'))
            found = found->next;
        if (found == NULL && (found = read_folder(picture, length)) != NULL) {
            found->next = shown->first;
            shown->first = found;
        }
    }
    return found;
}

void shown_free(Shown *shown) {
    while (shown->first != NULL) {
        ShownFolder *folder = shown->first;
        shown->first = folder->next;
        for (int i = 0; i < folder->view.panel_count; i++) {
            bool shared = false;
            for (int k = 0; k < i; k++) shared = shared || folder->runs[k] == folder->runs[i];
            if (!shared) trajectory_destroy(folder->runs[i]);
        }
        free(folder->path);
        free(folder);
    }
}
