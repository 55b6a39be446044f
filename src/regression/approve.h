/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accepts the changes that a comparison's report shows. Nothing else changes expected files.

     Approval approval;
     ApprovalRequest request = {.report = "out/report", .on_change = print_change};
     bool ok = approve(&request, &approval, error); */
#pragma once
#include "base/base.h"

#include <limits.h>
#include <stdint.h>

typedef struct Approval {
    int replaced, added, removed; /* files of the expected folder */
    int already;                  /* approved earlier */
    int kept;                     /* expected files without an actual one: MISSING_KEPT */
    int not_shown;                /* failures whose pictures the report omitted; not approved */
    int not_selected;             /* failures whose names do not match */
} Approval;

/* What becomes of expected files that have no actual one: a test may be gone, or the run may have drawn only some. */
typedef enum ApprovalMissing { MISSING_REFUSED, MISSING_KEPT, MISSING_REMOVED } ApprovalMissing;

typedef struct ApprovalRequest {
    const char *report;   /* folder of results.json */
    const char *expected; /* the folder to change; NULL: the one that results.json names, below the current directory */
    const char *only;     /* a glob (fnmatch) of file names; NULL: all */
    ApprovalMissing missing;
    /* After each file: "replaced", "added" or "removed"; of runs whose verdicts changed, these in words, else NULL. */
    void (*on_change)(const char *what, const char *path, const char *verdicts);
} ApprovalRequest;

/* Replaces the expected files of failures by the actual ones, in the folder that results.json names, and removes
   expected files whose actual file is missing, if the request says so: ERROR_INPUT, and nothing is changed, if it says
   nothing.

   Everything is checked before anything is written: names must be plain names of .png, .npz and .csv files, and both
   files must be regular files with the hashes in the report; otherwise ERROR_INPUT. Files are written atomically, in
   folders that stay open; no link below the expected folder is followed. */
bool approve(const ApprovalRequest *request, Approval *approval, Error *error);

/* What follows the current directory in the path, or the path itself if it is relative; NULL if it leads elsewhere:
   then approve() must be told the folder to change. Links are not looked at. */
const char *path_below_current(const char *path);

/* The failures of results.json. */

typedef struct ApprovalFile {
    char *name; /* relative to the folder; NULL: there was no file */
    uint64_t hash;
} ApprovalFile;

typedef struct ApprovalItem {
    bool failed, shown;
    ApprovalFile expected, actual;
    char *verdicts; /* of a run, before and after, in words; NULL: none, or no other */
} ApprovalItem;

typedef struct ApprovalList {
    char expected[PATH_MAX], actual[PATH_MAX]; /* folders */
    ApprovalItem *items;                       /* failures only */
    size_t count, capacity;
} ApprovalList;

/* ERROR_INPUT, with path:line:column, for anything that compare does not write, above all names that leave the folder,
   hidden names, names that do not end with .png, .npz or .csv, and, with the path alone, a file that is named twice. On
   failure nothing needs to be freed. Memory: at most four times the size of the file and 2 MiB. */
bool approval_read(ApprovalList *list, const char *path, Error *error);
void approval_free(ApprovalList *list);
