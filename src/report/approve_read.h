/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The failures that results.json lists. Only approve.c includes this. */
#pragma once
#include "common/error.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ApprovalFile {
    const char *name; /* malloc'ed; empty: there was no file */
    uint64_t hash;
} ApprovalFile;

typedef struct ApprovalItem {
    bool failed, shown;
    ApprovalFile expected, actual;
} ApprovalItem;

typedef struct ApprovalList {
    char expected[PATH_MAX], actual[PATH_MAX]; /* folders */
    ApprovalItem *items;                       /* those that failed */
    size_t count, capacity;
} ApprovalList;

/* ERROR_INPUT, with path:line:column, for what compare would not have written: above all a name with a folder in it, a
   hidden one, or one of neither .png nor .npz. On failure nothing is to be freed. */
bool approval_read(ApprovalList *list, const char *path, Error *error);
void approval_free(ApprovalList *list);
