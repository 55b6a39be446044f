/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "naming/shown.h"

#include "common/file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Errors are not reported: without a view or a run there are fewer names, and the comparison of runs reports a damaged
   run itself. */
static void read_run(ShownFolder *folder, const char *name) {
    char path[PATH_MAX];
    for (int i = 0; i < folder->run_count; i++)
        if (strcmp(folder->names[i], name) == 0) return;
    if (folder->run_count == VIEW_PANELS_MAX) return;
    if (file_path(path, sizeof path, &(Error){0}, "%s%s", folder->path, name))
        folder->runs[folder->run_count] = trajectory_read(path, &(Error){0});
    folder->names[folder->run_count++] = name;
}

static void read_runs(ShownFolder *folder) {
    for (int i = 0; i < folder->view.panel_count; i++) {
        const ViewPanel *panel = &folder->view.panels[i];
        read_run(folder, panel->run);
        for (int k = 0; k < panel->outline_count; k++) read_run(folder, panel->outlines[k]);
    }
}

const Trajectory *shown_run(const ShownFolder *folder, const char *name) {
    for (int i = 0; i < folder->run_count; i++)
        if (strcmp(folder->names[i], name) == 0) return folder->runs[i];
    return NULL;
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
        for (int i = 0; i < folder->run_count; i++) trajectory_destroy(folder->runs[i]);
        free(folder->path);
        free(folder);
    }
}
