/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file below a folder, held by the descriptor of the directory that it is in, so that no link leads out of the folder, even
   if one is made meanwhile. Only approve.c includes this. */
#pragma once
#include "common/error.h"

#include <limits.h>

typedef struct Place {
    int folder;          /* an open directory; -1 if there is no such folder */
    const char *name;    /* in it; points into the relative name */
    char path[PATH_MAX]; /* for messages */
} Place;

/* Opens the directory of root/name; `name` is relative, without "." and "..". create: makes the folders that are missing.
   ERROR_INPUT if one is a link or no folder. After success, place_close(). */
bool place_open(Place *place, const char *root, const char *name, bool create, Error *error);
void place_close(const Place *place);
