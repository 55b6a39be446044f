/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files below a folder. */
#pragma once
#include "common/error.h"

#include <stddef.h>

typedef struct FolderList {
    char **names; /* [count], relative to the folder ("sub/x.png"), sorted by strcmp */
    size_t count, capacity;
    size_t skipped; /* files in subfolders, if these are not listed */
} FolderList;

/* Lists the files that `wanted` accepts by their own names, also in subfolders if recursive. Hidden files and folders are
   ignored. Links to folders are not followed; links to files are, within the folder.

   ERROR_INPUT for a link that leads out of the folder, or to a hidden place in it: what lies there would be left out
   silently; and for a folder that does not exist. ERROR_SYSTEM if an entry cannot be read: half a list must never pass
   for the whole. On failure nothing needs to be freed. */
bool folder_list(FolderList *list, const char *folder, bool (*wanted)(const char *name), bool recursive, Error *error);
void folder_list_free(FolderList *list);

/* Sets an error from errno after a path could not be opened or inspected: ERROR_INPUT if nothing has that name,
   otherwise ERROR_SYSTEM. Returns false. */
bool folder_error(const char *path, Error *error);
