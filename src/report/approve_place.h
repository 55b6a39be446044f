/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Folders and the files below them, held by descriptors of their directories, so that no link leads out of a folder, even
   if one is made meanwhile. Only approve.c and the page, which states the command, include this. */
#pragma once
#include "common/error.h"

#include <limits.h>

typedef struct Root {
    int folder;       /* an open directory */
    const char *path; /* of the caller, for messages */
} Root;

typedef struct Place {
    int folder;          /* an open directory; -1 if there is no such folder */
    const char *name;    /* in it; points into the relative name */
    char path[PATH_MAX]; /* for messages */
} Place;

/* Opens a folder that the user named, or one that is only read: links in `path` are followed. Then root_close(). */
bool root_open(Root *root, const char *path, Error *error);

/* What follows the current directory in the path, or the path itself if it is relative; NULL if it leads elsewhere. Links
   are not looked at. */
const char *path_below_current(const char *path);

/* Opens a folder that a file named: ERROR_INPUT unless it lies below the current directory, without links on the way.
   report: that file, for messages. */
bool root_open_below(Root *root, const char *path, const char *report, Error *error);
void root_close(const Root *root);

/* Opens the directory of `name` in the root; `name` is relative, without "." and "..". create: makes the folders that are
   missing. ERROR_INPUT if one is a link or no folder. After success, place_close(). */
bool place_open(Place *place, const Root *root, const char *name, bool create, Error *error);
void place_close(const Place *place);
