/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the failures from results.json. Only approve.c includes this. */
#pragma once
#include "common/error.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ApprovalFile {
    const char *name; /* relative to the folder; empty: there was no file */
    uint64_t hash;
} ApprovalFile;

typedef struct ApprovalItem {
    bool failed, shown;
    ApprovalFile expected, actual;
} ApprovalItem;

typedef struct ApprovalList {
    char expected[PATH_MAX], actual[PATH_MAX]; /* folders */
    ApprovalItem *items;                       /* failures only */
    size_t count, capacity;
} ApprovalList;

/* ERROR_INPUT, with path:line:column, for anything that compare does not write, above all names that leave the folder,
   hidden names, names that do not end with .png or .npz, and a file that is named twice. On failure nothing needs to be
   freed. Memory: at most four times the size of the file and 2 MiB. */
bool approval_read(ApprovalList *list, const char *path, Error *error);
void approval_free(ApprovalList *list);

/* The name of the expected file; if that is new, of the actual one. */
const char *approval_target(const ApprovalItem *item);
